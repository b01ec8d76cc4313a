#include "common/scene_file/params.h"

#include <algorithm>

#include "common/scene_file/spectra.h"

namespace {

// Types that pbrt has and we do not.
const std::vector<std::string> pbrt_only = {
    "bilinearmesh",        "coatedconductor", "coateddiffuse", "curve",        "cylinder",
    "diffusetransmission", "gbuffer",         "goniometric",   "hair",         "interface",
    "loopsubdiv",          "measured",        "mix",           "orthographic", "projection",
    "realistic",           "spectral",        "spherical",     "spot",         "subsurface",
    "thindielectric"};

std::string list(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
    return text;
}

}  // namespace

Params::Params(Lexer& lexer, const Token& directive, bool has_type)
    : at_(lexer.at(directive)), type_at_(at_), directive_(directive.text) {
    if (has_type) {
        Token token = lexer.next();
        type_at_ = lexer.at(token);
        if (token.type != Token::string) {
            fail(type_at_, directive_ + " needs a type in quotes, not " + Lexer::describe(token));
        }
        type_ = lexer.unescape(token);
    }
    while (lexer.peek().type == Token::string) params_.push_back(read_param(lexer));
}

void Params::read_type() {
    const Param* param = find_exactly("string", "type", 1);
    if (!param) fail(at_, directive_ + " needs a \"string type\"");
    type_ = param->strings[0];
    type_at_ = param->at;
}

void Params::fail_type(const std::vector<std::string>& known) const {
    if (std::find(pbrt_only.begin(), pbrt_only.end(), type_) != pbrt_only.end()) {
        fail(type_at_, owner() + " is not supported (known: " + list(known) + ')');
    }
    fail_unknown(type_at_, directive_, type_, known);
}

const Position& Params::at(const std::string& name) const {
    for (size_t i = params_.size(); i-- > 0;) {
        if (params_[i].name == name) return params_[i].at;
    }
    return at_;
}

std::string Params::owner() const {
    return type_.empty() ? directive_ : directive_ + ' ' + quote(type_);
}

const Param* Params::find(const std::string& type, const std::string& name) {
    known_types_.push_back(type);
    known_names_.push_back(name);
    const Param* found = nullptr;
    for (Param& param : params_) {
        if (param.type != type || param.name != name) continue;
        param.used = true;
        found = &param;
    }
    return found;
}

const Param* Params::find_exactly(const std::string& type, const std::string& name, size_t count) {
    const Param* found = find(type, name);
    if (!found) return nullptr;
    size_t values = found->numbers.size() + found->strings.size() + found->bools.size();
    if (values != count) {
        fail(found->at, quote(type + ' ' + name) + " takes " + std::to_string(count) + " value" +
                            (count == 1 ? "" : "s") + ", not " + std::to_string(values));
    }
    return found;
}

float Params::number(const std::string& name, float fallback) {
    const Param* param = find_exactly("float", name, 1);
    return param ? static_cast<float>(param->numbers[0]) : fallback;
}

int Params::integer(const std::string& name, int fallback, int low, int high) {
    const Param* param = find_exactly("integer", name, 1);
    if (!param) return fallback;
    int value = static_cast<int>(param->numbers[0]);
    if (value < low || value > high) {
        fail(param->at, quote(name) + " must be from " + std::to_string(low) + " to " +
                            std::to_string(high) + ", not " + std::to_string(value));
    }
    return value;
}

bool Params::boolean(const std::string& name, bool fallback) {
    const Param* param = find_exactly("bool", name, 1);
    return param ? param->bools[0] : fallback;
}

std::string Params::string(const std::string& name, const std::string& fallback) {
    const Param* param = find_exactly("string", name, 1);
    return param ? param->strings[0] : fallback;
}

Vec3 Params::point(const std::string& name, Vec3 fallback) {
    const Param* param = find_exactly("point3", name, 3);
    if (!param) return fallback;
    return {static_cast<float>(param->numbers[0]), static_cast<float>(param->numbers[1]),
            static_cast<float>(param->numbers[2])};
}

Rgb Params::illuminant(const std::string& name, Rgb fallback) {
    if (const Param* param = find_exactly("blackbody", name, 1)) {
        double kelvin = param->numbers[0];
        if (kelvin < 500 || kelvin > 1e6) fail(param->at, "blackbody needs 500 to 1e6 kelvin");
        return blackbody_rgb(kelvin);
    }
    const Param* param = find_exactly("rgb", name, 3);
    if (!param) return fallback;
    Rgb L = {static_cast<float>(param->numbers[0]), static_cast<float>(param->numbers[1]),
             static_cast<float>(param->numbers[2])};
    if (L.r < 0 || L.g < 0 || L.b < 0) fail(param->at, quote(name) + " must not be negative");
    return L;
}

void Params::ignore(const std::string& type, const std::vector<std::string>& names) {
    for (const std::string& name : names) find(type, name);
}

void Params::finish() const {
    for (const Param& param : params_) {
        if (param.used) continue;
        // Say which types would do, where only the type is wrong.
        std::string types;
        for (size_t i = 0; i < known_names_.size(); i++) {
            if (known_names_[i] != param.name) continue;
            types += (types.empty() ? "" : " or ") + known_types_[i];
        }
        if (types.empty()) {
            std::vector<std::string> known = known_names_;
            std::sort(known.begin(), known.end());
            known.erase(std::unique(known.begin(), known.end()), known.end());
            fail_unknown(param.at, owner() + " parameter", param.name, known);
        }
        std::string hint = param.type == "texture" ? " (textures are not supported)" : "";
        fail(param.at, quote(param.name) + " of " + owner() + " must be of type " + types +
                           ", not " + param.type + hint);
    }
}

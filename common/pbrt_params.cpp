#include "common/pbrt_params.h"

#include <algorithm>
#include <array>
#include <limits>
#include <sstream>

#include "common/nearest.h"
#include "common/spectra.h"

namespace {

// What the values of a parameter are, and how many of them make one.
enum class ValueType { number, integer, string, boolean, string_or_number };
struct ParamType {
    const char* name;
    ValueType values;
    size_t group;
};
constexpr std::array<ParamType, 14> param_types = {{
    {"bool", ValueType::boolean, 1},
    {"float", ValueType::number, 1},
    {"integer", ValueType::integer, 1},
    {"point2", ValueType::number, 2},
    {"point3", ValueType::number, 3},
    {"vector2", ValueType::number, 2},
    {"vector3", ValueType::number, 3},
    {"normal", ValueType::number, 3},
    {"normal3", ValueType::number, 3},
    {"rgb", ValueType::number, 3},
    {"blackbody", ValueType::number, 1},
    {"spectrum", ValueType::string_or_number, 1},
    {"string", ValueType::string, 1},
    {"texture", ValueType::string, 1},
}};

// Types that pbrt has and we do not.
const std::vector<std::string> pbrt_only = {
    "bilinearmesh",        "coatedconductor", "coateddiffuse", "curve",        "cylinder",
    "diffusetransmission", "gbuffer",         "goniometric",   "hair",         "interface",
    "loopsubdiv",          "measured",        "mix",           "orthographic", "projection",
    "realistic",           "spectral",        "spherical",     "spot",         "subsurface",
    "thindielectric"};

const ParamType& find_type(const Position& at, const std::string& name) {
    std::vector<std::string> known;
    for (const ParamType& type : param_types) {
        if (type.name == name) return type;
        known.push_back(type.name);
    }
    // The third edition of pbrt had other names for these.
    if (name == "color") fail_unknown(at, "parameter type", name, {"rgb"});
    fail_unknown(at, "parameter type", name, known);
}

void read_number(const Lexer& lexer, const Token& token, Param& param) {
    std::optional<double> value = to_number(token.text);
    if (!value) fail(lexer.at(token), "expected a number, not " + Lexer::describe(token));
    if (!(std::abs(*value) <= std::numeric_limits<float>::max())) {
        fail(lexer.at(token), "number too large: " + std::string(token.text.substr(0, 60)));
    }
    param.numbers.push_back(*value);
}

void read_value(const Lexer& lexer, const Token& token, const ParamType& type, Param& param) {
    bool wants_string = type.values == ValueType::string ||
                        (type.values == ValueType::string_or_number && token.type == Token::string);
    if (wants_string) {
        if (token.type != Token::string) {
            fail(lexer.at(token), "expected a string in quotes for " +
                                      quote(param.type + ' ' + param.name) + ", not " +
                                      Lexer::describe(token));
        }
        param.strings.push_back(lexer.unescape(token));
    } else if (token.type != Token::word) {
        fail(lexer.at(token), "expected a value for " + quote(param.type + ' ' + param.name) +
                                  ", not " + Lexer::describe(token));
    } else if (type.values == ValueType::boolean) {
        if (token.text != "true" && token.text != "false") {
            fail(lexer.at(token), "expected true or false, not " + Lexer::describe(token));
        }
        param.bools.push_back(token.text == "true");
    } else if (type.values == ValueType::integer) {
        std::optional<int> value = to_integer(token.text);
        if (!value) fail(lexer.at(token), "expected a whole number, not " + Lexer::describe(token));
        param.numbers.push_back(*value);
    } else {
        read_number(lexer, token, param);
    }
}

Param read_param(Lexer& lexer) {
    Token declaration = lexer.next();
    Param param;
    param.at = lexer.at(declaration);
    std::string text = lexer.unescape(declaration), surplus;
    std::istringstream words(text);
    if (!(words >> param.type >> param.name) || words >> surplus) {
        fail(param.at, "expected \"type name\", not " + quote(text));
    }
    const ParamType& type = find_type(param.at, param.type);
    if (param.type == "normal3") param.type = "normal";

    if (lexer.peek().type != Token::open) {
        read_value(lexer, lexer.next(), type, param);
    } else {
        Token open = lexer.next();
        while (lexer.peek().type != Token::close) {
            if (lexer.peek().type == Token::end) fail(lexer.at(open), "the file ends before ]");
            read_value(lexer, lexer.next(), type, param);
        }
        lexer.next();
    }

    size_t count = param.numbers.size() + param.strings.size() + param.bools.size();
    if (count == 0) fail(param.at, quote(text) + " has no value");
    if (count % type.group != 0) {
        fail(param.at, quote(text) + " has " + std::to_string(count) +
                           " numbers, not a multiple of " + std::to_string(type.group));
    }
    return param;
}

std::string list(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
    return text;
}

}  // namespace

void fail_unknown(const Position& at, const std::string& kind, const std::string& word,
                  const std::vector<std::string>& known, const std::string& owner) {
    std::string nearest = nearest_word(word, known);
    std::string hint;
    if (!nearest.empty()) {
        hint = ": did you mean " + quote(nearest) + '?';
    } else if (!known.empty()) {
        hint = " (known: " + list(known) + ')';
    }
    fail(at, "unknown " + kind + ' ' + quote(word) + (owner.empty() ? "" : " of " + owner) + hint);
}

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

const Param* Params::find(const std::string& type, const std::string& name, size_t group) {
    known_.push_back(type + ' ' + name);
    known_names_.push_back(name);
    const Param* found = nullptr;
    for (Param& param : params_) {
        if (param.type != type || param.name != name) continue;
        param.used = true;
        found = &param;
    }
    if (found && found->numbers.size() % group != 0) {
        fail(found->at, quote(type + ' ' + name) + " has " + std::to_string(found->numbers.size()) +
                            " numbers, not a multiple of " + std::to_string(group));
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
        for (size_t i = 0; i < known_.size(); i++) {
            if (known_names_[i] != param.name) continue;
            std::string type = known_[i].substr(0, known_[i].find(' '));
            types += (types.empty() ? "" : " or ") + type;
        }
        if (types.empty()) fail_unknown(param.at, "parameter", param.name, known_names_, owner());
        std::string hint = param.type == "texture" ? " (textures are not supported)" : "";
        fail(param.at, quote(param.name) + " of " + owner() + " must be of type " + types +
                           ", not " + param.type + hint);
    }
}

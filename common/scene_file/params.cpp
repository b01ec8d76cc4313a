#include "common/scene_file/params.h"

#include <algorithm>
#include <map>

#include "common/base/numbers.h"

namespace {

// Types of pbrt's third edition that the fourth does not have.
const std::vector<std::string> pbrt_v3 = {
    "02sequence",  "ao",          "area",         "cone",           "directlighting",
    "disney",      "environment", "fourier",      "glass",          "heightfield",
    "hyperboloid", "image",       "kdsubsurface", "lowdiscrepancy", "matte",
    "maxmindist",  "metal",       "mirror",       "nurbs",          "paraboloid",
    "plastic",     "random",      "substrate",    "translucent",    "uber",
    "whitted"};
// Parameters that pbrt has and we do not, with the names of their stand-ins.
const std::map<std::string, std::string> pbrt_only_params = {
    {"alpha", "alpha"},
    {"displacement", "a bump or normal map"},
    {"displacement.edgelength", "a bump or normal map"},
    {"edgelength", "a bump or normal map"},
    {"emissionfilename", "an image on an area light"},
    {"normalmap", "a bump or normal map"},
    {"portal", "a portal"}};

bool contains(const std::vector<std::string>& words, const std::string& word) {
    return std::find(words.begin(), words.end(), word) != words.end();
}

std::string list(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
    return text;
}

}  // namespace

void check_range(const Param& param, double value, float low, float high) {
    float number = static_cast<float>(value);
    if (number >= low && number <= high) return;
    auto text = [](float x) {
        char digits[32];
        std::snprintf(digits, sizeof digits, "%g", double{x});
        return std::string(digits);
    };
    fail(param.at, quote(param.name) + " must be " +
                       (high < infinity ? "from " + text(low) + " to " + text(high)
                                        : "at least " + text(low)));
}

Rgb read_rgb(const Param& param, float low, float high) {
    for (double x : param.numbers) check_range(param, x, low, high);
    return {static_cast<float>(param.numbers[0]), static_cast<float>(param.numbers[1]),
            static_cast<float>(param.numbers[2])};
}

Params::Params(Lexer& lexer, const Token& directive, SceneNotes& notes, bool has_type,
               const std::vector<Param>& defaults)
    : notes_(&notes), at_(lexer.at(directive)), type_at_(at_), directive_(directive.text) {
    if (has_type) {
        Token token = lexer.next();
        type_at_ = lexer.at(token);
        if (token.type != Token::string) {
            fail(type_at_, directive_ + " needs a type in quotes, not " + Lexer::describe(token));
        }
        type_ = lexer.unescape(token);
        refuse_old_type();
    }
    while (lexer.peek().type == Token::string) add(read_param(lexer));
    for (const Param& param : defaults) {
        auto same_name = [&](const Param& other) { return other.name == param.name; };
        if (std::any_of(params_.begin(), params_.end(), same_name)) continue;
        params_.push_back(param);
        params_.back().used = !pbrt_only_params.contains(param.name);
    }
    // Say here what is wrong, not where a parameter behind it is missing.
    const Token& after = lexer.peek();
    bool is_value = after.type == Token::open || after.type == Token::close ||
                    (after.type == Token::word && to_number(after.text));
    if (is_value) fail(lexer.at(after), "expected a directive, not " + Lexer::describe(after));
}

// Of two with one name the first is forgotten, whatever its type is.
void Params::add(Param param) {
    constexpr size_t most = 100;
    if (params_.size() == most) fail(param.at, owner() + " has more than 100 parameters");
    auto same_name = [&](const Param& other) { return other.name == param.name; };
    if (std::erase_if(params_, same_name) > 0) {
        notes_->add(param.at,
                    quote(param.name) + " of " + owner() + " is given twice: the last one counts");
    }
    params_.push_back(std::move(param));
}

void Params::read_type() {
    const Param* param = find_exactly("string", "type", 1);
    if (!param) fail(at_, directive_ + " needs a \"string type\"");
    type_ = param->strings[0];
    type_at_ = param->at;
    refuse_old_type();
}

// One message about a scene of pbrt-v3 is enough: nearly every line of it has to change.
void Params::refuse_old_type() const {
    if (!contains(pbrt_v3, type_)) return;
    stop_reading(type_at_, owner() + " is of pbrt-v3: let pbrt-v4 convert the scene, by " +
                               "pbrt --upgrade old.pbrt > new.pbrt");
}

bool Params::stands_in() {
    if (!may_stand_in() || or_stand_in(table_name()).empty()) return false;
    notes_->stand_in(type_at_, table_name());
    return true;
}

void Params::fail_type(const std::vector<std::string>& known) const {
    std::string hint = or_stand_in(table_name());
    if (!hint.empty()) {
        fail(type_at_, owner() + " is not supported (known: " + list(known) + ')' + hint);
    }
    fail_unknown(type_at_, directive_, type_, known);
}

const Position& Params::at(const std::string& name) const {
    for (const Param& param : params_) {
        if (param.name == name) return param.at;
    }
    return at_;
}

std::string Params::table_name() const {
    return (directive_ == "MakeNamedMaterial" ? "Material" : directive_) + ' ' + quote(type_);
}

std::string Params::owner() const {
    return type_.empty() ? directive_ : directive_ + ' ' + quote(type_);
}

const Param* Params::find(const std::string& type, const std::string& name) {
    known_types_.push_back(type);
    known_names_.push_back(name);
    for (Param& param : params_) {
        if (param.type != type || param.name != name) continue;
        param.used = true;
        return &param;
    }
    return nullptr;
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

float Params::number(const std::string& name, float fallback, float low, float high) {
    const Param* param = find_exactly("float", name, 1);
    if (!param) return fallback;
    check_range(*param, param->numbers[0], low, high);
    return static_cast<float>(param->numbers[0]);
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
    if (const Param* param = find("spectrum", name)) named<Rgb>(*param, {});
    const Param* param = find_exactly("rgb", name, 3);
    if (!param) return fallback;
    return read_rgb(*param, 0, infinity);
}

template <class Value>
const Value* Params::named(const Param& spectrum, const std::map<std::string, Value>& known) {
    if (spectrum.strings.size() != 1) {
        stand_in(spectrum.at, "a spectrum as a list");
        return nullptr;
    }
    const std::string& name = spectrum.strings[0];
    auto found = known.find(name);
    if (found != known.end()) return &found->second;
    std::vector<std::string> names;
    for (const auto& [word, value] : known) names.push_back(word);
    stand_in(spectrum.at, "a spectrum of unknown name", unknown("spectrum", name, names));
    return nullptr;
}
template const Rgb* Params::named(const Param&, const std::map<std::string, Rgb>&);
template const Glass* Params::named(const Param&, const std::map<std::string, Glass>&);

void Params::ignore(const std::string& type, const std::vector<std::string>& names) {
    for (const std::string& name : names) find(type, name);
}

void Params::stand_in(const Position& at, const std::string& what, const std::string& text) {
    if (may_stand_in()) return notes_->stand_in(at, what);
    std::string hint = or_stand_in(what);
    if (text.ends_with('?')) hint.erase(0, 1);
    std::string wrong = text.empty() ? what + " is not supported" : text;
    wrong_.push_back(message_at(at, "error", wrong + hint));
}

void Params::replace(const std::string& type, const std::string& name, const std::string& what) {
    const Param* param = find(type, name);
    if (param) stand_in(param->at, what, quote(name) + " is not supported");
}

bool Params::read(const std::function<void()>& reader, const std::string& stand_in) {
    try {
        reader();
        return true;
    } catch (const InputError& error) {
        std::string text = error.what();
        if (!stand_in.empty() && may_stand_in()) {
            notes_->stand_in(at_, stand_in);
        } else {
            // Files that are missing or damaged need a remedy, those of a format that pbrt reads
            // and we do not may need a stand-in.
            bool is_exr = text.find(".exr") != std::string::npos;
            wrong_.push_back(text + (is_exr ? or_stand_in(stand_in) : ""));
        }
        return false;
    }
}

void Params::ignore_rest() {
    for (Param& param : params_) {
        auto only_pbrt = pbrt_only_params.find(param.name);
        if (!param.used && may_stand_in() && only_pbrt != pbrt_only_params.end()) {
            notes_->stand_in(param.at, only_pbrt->second);
        }
        param.used = true;
    }
}

void Params::finish() {
    std::vector<std::string> wrong = wrong_;
    for (const Param& param : params_) {
        if (param.used) continue;
        bool is_known = contains(known_names_, param.name);
        auto only_pbrt = pbrt_only_params.find(param.name);
        if (may_stand_in() && !is_known && only_pbrt != pbrt_only_params.end()) {
            notes_->stand_in(param.at, only_pbrt->second);
        } else if (may_stand_in() && is_known && param.type == "texture") {
            notes_->stand_in(param.at, "a texture that is no reflectance");
        } else {
            wrong.push_back(message_at(param.at, "error", what_is_wrong_with(param)));
        }
    }
    if (!wrong.empty()) throw InputError(join_lines(wrong));
}

// Of a parameter that nobody asked for.
std::string Params::what_is_wrong_with(const Param& param) const {
    // Say which types would do, where only the type is wrong.
    std::string types;
    for (size_t i = 0; i < known_names_.size(); i++) {
        if (known_names_[i] != param.name) continue;
        types += (types.empty() ? "" : " or ") + known_types_[i];
    }
    auto only_pbrt = pbrt_only_params.find(param.name);
    if (types.empty() && only_pbrt != pbrt_only_params.end()) {
        return quote(param.name) + " of " + owner() + " is not supported" +
               or_stand_in(only_pbrt->second);
    }
    if (types.empty()) {
        std::vector<std::string> known = known_names_;
        std::sort(known.begin(), known.end());
        known.erase(std::unique(known.begin(), known.end()), known.end());
        return unknown(owner() + " parameter", param.name, known);
    }
    std::string hint;
    if (param.type == "texture") {
        hint = " (only a reflectance can be a texture)" +
               or_stand_in("a texture that is no reflectance");
    }
    return quote(param.name) + " of " + owner() + " must be of type " + types + ", not " +
           param.type + hint;
}

// The parameters that follow a directive of a pbrt-v4 scene file: `"float fov" 45`.
#pragma once
#include <algorithm>
#include <sstream>

#include "common/base/text.h"
#include "common/base/vec.h"
#include "common/material/spectrum.h"
#include "common/scene_file/input.h"
#include "common/scene_file/lexer.h"

struct Param {
    std::string type, name;
    Position at;
    std::vector<double> numbers;  // also of integers, points and colors; of bools 0 or 1
    std::vector<std::string> strings;
    bool is_default = false;  // given by Attribute, also to directives that do not know it
};
/// Parameters by their names.
using ParamMap = std::map<std::string, Param>;

/// The words between blanks.
inline std::vector<std::string> words_of(const std::string& line) {
    std::vector<std::string> words;
    std::istringstream in(line);
    for (std::string word; in >> word;) words.push_back(word);
    return words;
}
inline bool has_word(const std::string& line, const std::string& word) {
    return (' ' + line + ' ').find(' ' + word + ' ') != std::string::npos;
}

/// The types of parameters, and how many numbers or strings make one.
inline const std::map<std::string, size_t> param_types = {
    {"blackbody", 1}, {"bool", 1},    {"float", 1},  {"integer", 1},  {"normal", 3},
    {"point3", 3},    {"point2", 2},  {"rgb", 3},    {"spectrum", 1}, {"string", 1},
    {"texture", 1},   {"vector3", 3}, {"vector2", 2}};

// One message about a scene of pbrt-v3 is enough: nearly every line of it has to change.
inline void refuse_old(const Position& at, const std::string& word) {
    if (!has_word("area glass image matte metal mirror plastic substrate uber", word)) return;
    stop_reading(at, quote(word) + " is of pbrt-v3: let pbrt-v4 convert the scene, by " +
                         "pbrt --upgrade old.pbrt > new.pbrt");
}

// Adds one value to the parameter.
inline void read_value(Lexer& lexer, Param& param) {
    const std::string &type = param.type, name = quote(type + ' ' + param.name);
    bool is_string = lexer.peek().type == Token::string;
    if (type == "string" || type == "texture" || (type == "spectrum" && is_string)) {
        Token token = lexer.expect(Token::string, name + " needs a string in quotes");
        param.strings.push_back(lexer.unescape(token));
    } else if (type == "bool" || type == "integer") {
        Token token = lexer.next();
        bool is_true = token.text == "true";
        std::optional<double> value;
        if (type == "integer") value = to_integer(token.text);
        if (type == "bool" && (is_true || token.text == "false")) value = is_true;
        const std::string needs = type == "bool" ? " needs true or false" : " needs a whole number";
        if (is_string || !value) lexer.fail_at(token, name + needs);
        param.numbers.push_back(*value);
    } else {
        param.numbers.push_back(lexer.number(name));
    }
}

/// Reads a declaration and its value or values, and checks that they fit the type.
inline Param read_param(Lexer& lexer) {
    Token declaration = lexer.next();
    Param param;
    param.at = lexer.at(declaration);
    const std::string declared = lexer.unescape(declaration);
    std::vector<std::string> words = words_of(declared);
    if (words.size() != 2) fail(param.at, "expected \"type name\", not " + quote(declared));
    param.type = words[0];
    param.name = words[1];
    refuse_old(param.at, param.type);
    look_up(param_types, param.type, "parameter type", param.at);
    bool is_list = lexer.peek().type == Token::opens;
    if (is_list) lexer.next();
    do {
        read_value(lexer, param);
    } while (is_list && lexer.peek().type != Token::closes);
    if (is_list) lexer.next();
    return param;
}

/// A row of the table of parameters, see supported.cpp. Words are separated by blanks.
struct ParamRow {
    const char *directive, *kinds;                 // kinds: the types of the directive
    const char *types, *names;                     // types: such as "rgb or texture"
    double fallback = 0, low = -double{infinity};  // of each number
    double high = double{infinity};
    size_t values = 1;          // how many numbers, points or strings; 0: any number
    const char* stand_in = "";  // of parameters that only pbrt has
};
/// The rows of the parameters of a directive of one type, by their names.
using KnownParams = std::map<std::string, const ParamRow*>;
/// Those of each directive, by its type, such as those of Shape and "disk".
const std::map<std::string, std::map<std::string, KnownParams>>& known_params();

/// The parameters of one directive, of which all that is wrong is told. Those that cannot be used
/// are left out; of two with one name the last one counts.
class Params {
public:
    /// Reads what follows `directive`: its type, such as "perspective", and the parameters up to a
    /// token that is none; `defaults` count where it has none of their name. Throws for a type that
    /// is unknown.
    Params(Lexer& lexer, const std::string& directive, const Position& at, Input& input,
           const ParamMap& defaults)
        : input_(&input), at_(at), directive_(directive), params_(defaults) {
        bool is_named = directive_ == "MakeNamedMaterial";  // of which the type is a parameter
        const std::string needs = directive_ + " needs a type in quotes";
        if (!is_named) type_ = lexer.unescape(lexer.expect(Token::string, needs));
        while (lexer.peek().type == Token::string) {
            Param param = read_param(lexer);
            check_limit(param.at, params_.size() + 1, 100, "parameters of one directive");
            params_[param.name] = std::move(param);
        }
        // Say here what is wrong, not where a parameter behind it is missing.
        if (lexer.has_argument()) lexer.fail_at(lexer.peek(), "expected a directive");
        if (is_named) {
            const Param& type = required("type");
            if (type.type == "string") type_ = type.strings[0];
            directive_ = "Material";
            params_.erase("type");
        }
        stands_in_ = !or_stand_in(owner()).empty();
        if (stands_in_) stand_in(owner());
        const auto& types = known_params().at(directive_);
        if (!types.contains(type_)) {
            refuse_old(at_, type_);
            std::vector<std::string> known = names_of(types);
            std::erase_if(known, [&](const std::string& type) {
                return type.empty() || !or_stand_in(directive_ + ' ' + quote(type)).empty();
            });
            fail(at_, unknown(directive_, type_, known));
        }
        known_ = &types.at(type_);
        std::erase_if(params_, [&](const auto& param) { return !is_usable(param.second); });
    }

    const std::string& type() const { return type_; }
    /// Whether the type is not supported: what is read stands in for it.
    bool stands_in() const { return stands_in_; }
    Input& input() const { return *input_; }
    /// Where the directive stands, and where a parameter does (the directive if it is not given).
    const Position& at(const std::string& name = "") const {
        const Param* param = find(name);
        return param ? param->at : at_;
    }
    /// The directive and its type, for messages.
    std::string owner() const { return directive_ + ' ' + quote(type_); }
    /// Says of the directive that it is not done as the file says; of what `name` gives, or of the
    /// directive, that it is not modelled.
    void note(const std::string& text) const { input_->note(at_, owner() + ' ' + text); }
    void stand_in(const std::string& what, const std::string& name = "") const {
        input_->stand_in(at(name), what);
    }

    /// The parameter of this name; null if not given.
    const Param* find(const std::string& name) const {
        auto found = params_.find(name);
        return found == params_.end() ? nullptr : &found->second;
    }
    /// The same; throws if not given.
    const Param& required(const std::string& name) const {
        const Param* param = find(name);
        if (!param) fail(at_, owner() + " needs a parameter " + quote(name));
        return *param;
    }
    /// The value of a parameter; where it is not given that of the table, or the one given here.
    float number(const std::string& name, std::optional<float> fallback = {}) const {
        const Param* param = find(name);
        if (param && !param->numbers.empty()) return static_cast<float>(param->numbers[0]);
        auto row = known_->find(name);
        double usual = row == known_->end() ? 0 : row->second->fallback;
        return fallback.value_or(static_cast<float>(usual));
    }
    int integer(const std::string& name) const { return static_cast<int>(number(name)); }
    bool boolean(const std::string& name) const { return number(name) != 0; }
    std::string string(const std::string& name, const std::string& fallback = "") const {
        const Param* param = find(name);
        return param ? param->strings[0] : fallback;
    }
    /// All points, vectors or normals; none where the parameter is not given.
    std::vector<Vec3> points(const std::string& name) const {
        std::vector<Vec3> all;
        const Param* param = find(name);
        for (size_t i = 0; param && i + 2 < param->numbers.size(); i += 3) {
            all.push_back(
                to_vec3({param->numbers[i], param->numbers[i + 1], param->numbers[i + 2]}));
        }
        return all;
    }
    Vec3 point(const std::string& name, Vec3 fallback) const {
        std::vector<Vec3> all = points(name);
        return all.empty() ? fallback : all[0];
    }
    /// An `rgb`, or the color of luminance 1 of a `blackbody`.
    Rgb color(const std::string& name) const {
        const Param* param = find(name);
        if (param && param->type == "blackbody") return blackbody_rgb(param->numbers[0]);
        float each = number(name);
        Vec3 rgb = point(name, {each, each, each});
        return {rgb.x, rgb.y, rgb.z};
    }

private:
    bool is_usable(const Param& param) const {
        const std::string given = quote(param.type + ' ' + param.name) + " of " + owner();
        auto found = known_->find(param.name);
        if (found == known_->end()) {
            std::string wrong = unknown(owner() + " parameter", param.name, names_of(*known_));
            if (!stands_in_ && !param.is_default) input_->error(param.at, wrong);
            return false;
        }
        const ParamRow& row = *found->second;
        if (*row.stand_in) {
            input_->stand_in(param.at, row.stand_in, given + " is not supported");
            return true;
        }
        size_t count = param.numbers.size() + param.strings.size();
        size_t group = std::max(row.values, size_t{1}) * param_types.at(param.type);
        bool is_spectrum = param.type == "spectrum";
        auto is_outside = [&](double x) { return x < row.low || x > row.high; };
        std::string wrong, stand_in;
        if (!has_word(row.types, param.type) || (is_spectrum && param.strings.empty())) {
            wrong = given + " must be of type " + row.types;
            if (param.type == "texture") stand_in = "a texture that is no reflectance";
            if (is_spectrum) stand_in = "a spectrum that is not known";
        } else if (row.values > 0 ? count != group : count % group != 0) {
            wrong = given + " has " + std::to_string(count) + " values, not " +
                    (row.values > 0 ? "" : "a multiple of ") + std::to_string(group);
        } else if (std::any_of(param.numbers.begin(), param.numbers.end(), is_outside)) {
            wrong =
                quote(param.name) + " must be from " + format("%.10g to %.10g", row.low, row.high);
        }
        if (!stand_in.empty()) {
            input_->stand_in(param.at, stand_in, wrong);
        } else if (!wrong.empty() && !stands_in_) {
            input_->error(param.at, wrong);
        }
        return wrong.empty();
    }

    Input* input_;
    Position at_;
    std::string directive_, type_;
    bool stands_in_ = false;
    const KnownParams* known_ = nullptr;
    ParamMap params_;
};

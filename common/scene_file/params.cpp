#include "common/scene_file/params.h"

#include <algorithm>
#include <array>
#include <sstream>

#include "common/base/text.h"
#include "common/material/spectrum.h"

namespace {

struct ParamType {
    std::string_view needs;  // what each of its values must be
    size_t group = 1;        // how many of them make one
    double low = -double{infinity}, high = double{infinity};
};
constexpr std::string_view number = "a number", text = "a string in quotes",
                           whole = "a whole number", truth = "true or false",
                           spectrum = "a name or numbers";
const std::map<std::string, ParamType> param_types = {{"blackbody", {number, 1, 500, 1e6}},
                                                      {"bool", {truth}},
                                                      {"float", {number}},
                                                      {"integer", {whole}},
                                                      {"normal", {number, 3}},
                                                      {"point3", {number, 3}},
                                                      {"point2", {number, 2}},
                                                      {"rgb", {number, 3}},
                                                      {"spectrum", {spectrum}},
                                                      {"string", {text}},
                                                      {"texture", {text}},
                                                      {"vector3", {number, 3}},
                                                      {"vector2", {number, 2}}};

// One message about a scene of pbrt-v3 is enough: nearly every line of it has to change.
void refuse_old(const Position& at, const std::string& word) {
    for (const char* old :
         {"area", "glass", "image", "matte", "metal", "mirror", "plastic", "substrate", "uber"}) {
        if (word != old) continue;
        stop_reading(at, quote(word) + " is of pbrt-v3: let pbrt-v4 convert the scene, by " +
                             "pbrt --upgrade old.pbrt > new.pbrt");
    }
}

// Adds one value to the parameter.
void read_value(Lexer& lexer, const ParamType& type, Param& param) {
    std::string name = quote(param.type + ' ' + param.name);
    Token token = lexer.peek();
    bool is_text = type.needs == text, is_either = type.needs == spectrum;
    if (token.type == Token::string && (is_text || is_either)) {
        param.strings.push_back(lexer.unescape(lexer.next()));
    } else if (type.needs == number || is_either) {
        param.numbers.push_back(lexer.number(name));
    } else {
        lexer.next();
        std::optional<double> value;
        if (type.needs == whole) value = to_integer(token.text);
        if (type.needs == truth && token.text == "true") value = 1;
        if (type.needs == truth && token.text == "false") value = 0;
        if (!value || token.type != Token::word) {
            lexer.fail_at(token, name + " needs " + std::string(type.needs));
        }
        param.numbers.push_back(*value);
    }
}

auto named(const std::string& name) {
    return [&](const Param& param) { return param.name == name; };
}

std::string digits(double x) {
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%.10g", x);
    return buffer;
}

}  // namespace

std::vector<std::string> words_of(const std::string& line) {
    std::vector<std::string> words;
    std::istringstream in(line);
    for (std::string word; in >> word;) words.push_back(word);
    return words;
}

Param read_param(Lexer& lexer) {
    Token declaration = lexer.next();
    Param param;
    param.at = lexer.at(declaration);
    const std::string declared = lexer.unescape(declaration);
    std::vector<std::string> words = words_of(declared);
    if (words.size() != 2) fail(param.at, "expected \"type name\", not " + quote(declared));
    param.type = words[0];
    param.name = words[1];
    refuse_old(param.at, param.type);
    const ParamType& type = look_up(param_types, param.type, "parameter type", param.at);
    if (lexer.peek().type != Token::open) {
        read_value(lexer, type, param);
    } else {
        Token open = lexer.next();
        while (lexer.peek().type != Token::close) {
            if (lexer.peek().type == Token::end) fail(lexer.at(open), "the file ends before ]");
            read_value(lexer, type, param);
        }
        lexer.next();
    }
    if (param.numbers.empty() && param.strings.empty())
        fail(param.at, quote(declared) + " is empty");
    return param;
}

Params::Params(Lexer& lexer, const std::string& directive, const Position& at, Input& input,
               const std::vector<Param>& defaults)
    : input_(&input), at_(at), directive_(directive) {
    bool is_named = directive_ == "MakeNamedMaterial";  // of which the type is a parameter
    Position type_at = at_;
    if (!is_named) {
        Token token = lexer.expect(Token::string, directive_ + " needs a type in quotes");
        type_ = lexer.unescape(token);
        type_at = lexer.at(token);
    }
    while (lexer.peek().type == Token::string) {
        Param param = read_param(lexer);
        check_limit(param.at, params_.size() + 1, 100, "parameters of one directive");
        if (std::erase_if(params_, named(param.name)) > 0) {
            input.note(param.at, quote(param.name) + " of " + owner() +
                                     " is given twice: the last one counts");
        }
        params_.push_back(std::move(param));
    }
    for (size_t i = defaults.size(); i-- > 0;) {
        if (!find(defaults[i].name)) params_.push_back(defaults[i]);
    }
    // Say here what is wrong, not where a parameter behind it is missing.
    if (lexer.has_argument()) lexer.fail_at(lexer.peek(), "expected a directive");
    if (is_named) {
        const Param& type = required("type");
        if (type.type == "string") type_ = type.strings[0];
        type_at = type.at;
        directive_ = "Material";
        std::erase_if(params_, named("type"));
    }
    check_type(type_at);
    std::erase_if(params_, [&](const Param& param) { return !is_usable(param); });
}

void Params::check_type(const Position& at) {
    stands_in_ = !or_stand_in(owner()).empty();
    if (stands_in_) input_->stand_in(at, owner());
    const auto& types = known_params().at(directive_);
    auto found = types.find(type_);
    if (found == types.end()) {
        refuse_old(at, type_);
        std::vector<std::string> known = names_of(types);
        std::erase_if(known, [&](const std::string& type) {
            return !or_stand_in(directive_ + ' ' + quote(type)).empty();
        });
        fail_unknown(at, directive_, type_, known);
    }
    known_ = &found->second;
}

bool Params::is_usable(const Param& param) const {
    const std::string given = quote(param.type + ' ' + param.name) + " of " + owner();
    auto found = known_->find(param.name);
    if (found == known_->end()) {
        if (param.is_default || stands_in_) return false;
        input_->error(param.at, unknown(owner() + " parameter", param.name, names_of(*known_)));
        return false;
    }
    const ParamRow& row = *found->second;
    if (*row.stand_in) {
        input_->stand_in(param.at, row.stand_in, given + " is not supported");
        return true;
    }
    const ParamType& type = param_types.at(param.type);
    const std::vector<std::string> types = words_of(row.types);
    size_t count = param.numbers.size() + param.strings.size();
    size_t group = std::max(row.values, size_t{1}) * type.group;
    double low = std::max(row.low, type.low), high = std::min(row.high, type.high);
    auto is_outside = [&](double x) { return x < low || x > high; };
    std::string wrong, stand_in;
    if (std::find(types.begin(), types.end(), param.type) == types.end() ||
        (param.type == "spectrum" && param.strings.empty())) {
        wrong = given + " must be of type " + row.types;
        if (param.type == "texture") stand_in = "a texture that is no reflectance";
        if (param.type == "spectrum") stand_in = "a spectrum that is not known";
    } else if (row.values > 0 ? count != group : count % group != 0) {
        wrong = given + " has " + std::to_string(count) + " values, not " +
                (row.values > 0 ? "" : "a multiple of ") + std::to_string(group);
    } else if (std::any_of(param.numbers.begin(), param.numbers.end(), is_outside)) {
        wrong = quote(param.name) + " must be from " + digits(low) + " to " + digits(high);
    }
    if (!stand_in.empty()) {
        input_->stand_in(param.at, stand_in, wrong);
    } else if (!wrong.empty() && !stands_in_) {
        input_->error(param.at, wrong);
    }
    return wrong.empty();
}

float Params::number(const std::string& name) const {
    auto row = known_->find(name);
    return number(name, row == known_->end() ? 0 : static_cast<float>(row->second->fallback));
}

const Param* Params::find(const std::string& name) const {
    auto found = std::find_if(params_.begin(), params_.end(), named(name));
    return found == params_.end() ? nullptr : &*found;
}

const Param& Params::required(const std::string& name) const {
    const Param* param = find(name);
    if (!param) fail(at_, owner() + " needs a parameter " + quote(name));
    return *param;
}

float Params::number(const std::string& name, float fallback) const {
    const Param* param = find(name);
    return param && !param->numbers.empty() ? static_cast<float>(param->numbers[0]) : fallback;
}

std::vector<Vec3> Params::points(const std::string& name) const {
    std::vector<Vec3> all;
    const Param* param = find(name);
    if (param) all.resize(param->numbers.size() / 3);
    for (size_t i = 0; i < 3 * all.size(); i++) {
        all[i / 3][static_cast<int>(i % 3)] = static_cast<float>(param->numbers[i]);
    }
    return all;
}

Rgb Params::color(const std::string& name) const {
    const Param* param = find(name);
    if (param && param->type == "blackbody") return blackbody_rgb(param->numbers[0]);
    float each = number(name);
    Vec3 rgb = point(name, {each, each, each});
    return {rgb.x, rgb.y, rgb.z};
}

#include "common/scene_file/param.h"

#include <array>
#include <sstream>

#include "common/base/numbers.h"

namespace {

struct ParamType {
    std::string_view name;
    std::string_view needs;  // what each of its values must be
    size_t group;            // how many of them make one
};
constexpr std::string_view number = "a number", text = "a string in quotes";
constexpr std::array<ParamType, 13> param_types = {{{"blackbody", number, 1},
                                                    {"bool", "true or false", 1},
                                                    {"float", number, 1},
                                                    {"integer", "a whole number", 1},
                                                    {"normal", number, 3},
                                                    {"point3", number, 3},
                                                    {"point2", number, 2},
                                                    {"rgb", number, 3},
                                                    {"spectrum", "a name or numbers", 1},
                                                    {"string", text, 1},
                                                    {"texture", text, 1},
                                                    {"vector3", number, 3},
                                                    {"vector2", number, 2}}};

const ParamType& find_type(const Position& at, const std::string& name) {
    std::vector<std::string> known;
    for (const ParamType& type : param_types) {
        if (type.name == name) return type;
        known.emplace_back(type.name);
    }
    fail_unknown(at, "parameter type", name, known);
}

// Adds one value to the parameter.
void read_value(const Lexer& lexer, const Token& token, const ParamType& type, Param& param) {
    bool is_string = type.needs == text || param.type == "spectrum";
    if (token.type == Token::string && is_string) {
        param.strings.push_back(lexer.unescape(token));
        return;
    }
    std::string name = quote(param.type + ' ' + param.name);
    if (token.type == Token::word && (type.needs == number || param.type == "spectrum")) {
        param.numbers.push_back(lexer.number(token, name));
        return;
    }
    if (token.type == Token::word && param.type == "integer") {
        if (std::optional<int> value = to_integer(token.text)) {
            param.numbers.push_back(*value);
            return;
        }
    }
    if (token.type == Token::word && param.type == "bool") {
        if (token.text == "true" || token.text == "false") {
            param.bools.push_back(token.text == "true");
            return;
        }
    }
    fail(lexer.at(token),
         name + " needs " + std::string(type.needs) + ", not " + Lexer::describe(token));
}

}  // namespace

Param read_param(Lexer& lexer) {
    Token declaration = lexer.next();
    Param param;
    param.at = lexer.at(declaration);
    std::string declared = lexer.unescape(declaration), surplus;
    std::istringstream words(declared);
    if (!(words >> param.type >> param.name) || words >> surplus) {
        fail(param.at, "expected \"type name\", not " + quote(declared));
    }
    const ParamType& type = find_type(param.at, param.type);

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
    if (count == 0) fail(param.at, quote(declared) + " has no value");
    if (count % type.group != 0) {
        fail(param.at, quote(declared) + " has " + std::to_string(count) +
                           " numbers, not a multiple of " + std::to_string(type.group));
    }
    return param;
}

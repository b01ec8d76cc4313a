#include <array>

#include "common/scene_file/scene_parts.h"

namespace {

Vec3d read_three(Lexer& lexer, const std::string& name) {
    Vec3d v;
    for (double* x : {&v.x, &v.y, &v.z}) *x = lexer.number(name);
    return v;
}

// Reads [ 16 numbers ], column by column.
Transform read_matrix(Lexer& lexer, const Token& directive) {
    std::string name(directive.text);
    lexer.expect(Token::open, name + " needs [ and 16 numbers");
    std::array<double, 16> m;
    for (double& x : m) x = lexer.number(name);
    lexer.expect(Token::close, name + " needs ] after 16 numbers");

    constexpr double tolerance = 1e-6;
    double bottom = std::abs(m[3]) + std::abs(m[7]) + std::abs(m[11]) + std::abs(m[15] - 1);
    if (bottom > tolerance) m = {};
    return {{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}, {m[12], m[13], m[14]}};
}

}  // namespace

bool is_usable(const Transform& t) {
    constexpr double largest = 1e30;
    for (Vec3d v : {t.x, t.y, t.z, t.o}) {
        for (double x : {v.x, v.y, v.z}) {
            if (!(std::abs(x) <= largest)) return false;
        }
    }
    return std::abs(determinant(t)) > 1 / (largest * largest);
}

Transform read_transform(Lexer& lexer, const Token& directive) {
    std::string name(directive.text);
    if (name == "Identity") return {};
    if (name == "Transform" || name == "ConcatTransform") return read_matrix(lexer, directive);
    if (name == "Translate") return translation(read_three(lexer, name));
    if (name == "Scale") return scaling(read_three(lexer, name));
    if (name == "Rotate") {
        double degrees = lexer.number(name);
        return rotation(degrees, read_three(lexer, name));
    }
    Vec3d eye = read_three(lexer, name), look = read_three(lexer, name);
    Vec3d up = read_three(lexer, name);
    return inverse(look_at(eye, look, up));
}

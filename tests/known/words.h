// The words of small scenes: materials, shapes and places in pbrt's language.
#pragma once
#include "common/base/text.h"

inline std::string group(const std::string& inside) {
    return "AttributeBegin " + inside + "AttributeEnd\n";
}
inline std::string at(double x, double y, double z) {
    return format("Translate %g %g %g ", x, y, z);
}
inline std::string scale(double s) { return format("Scale %g %g %g ", s, s, s); }
inline std::string turn(double degrees, const char* axis) {
    return format("Rotate %g %s ", degrees, axis);
}
inline constexpr const char *x_axis = "1 0 0", *z_axis = "0 0 1";

inline std::string paint(double albedo) {
    return format("Material \"diffuse\" \"rgb reflectance\" [%g %g %g]\n", albedo, albedo, albedo);
}
inline const std::string glass = "Material \"dielectric\"\n";
/// Metal that reflects this share in every direction.
inline std::string metal(double share, const std::string& more = "") {
    return format("Material \"conductor\" \"rgb reflectance\" [%g %g %g] ", share, share, share) +
           more + "\n";
}
inline const std::string rough = "\"float roughness\" 0.5 \"bool remaproughness\" false";
inline const std::string smoother = "\"float roughness\" 0.2 \"bool remaproughness\" false";
inline std::string shining(double L, bool two_sided = false) {
    return format("AreaLightSource \"diffuse\" \"rgb L\" [%g %g %g] \"bool twosided\" %s ", L, L, L,
                  two_sided ? "true" : "false");
}

/// A square of side 2 around the origin that faces up or down, and the same with normals that are
/// other ones.
inline std::string square(bool up, const std::string& normals = "") {
    return std::string("Shape \"trianglemesh\" \"integer indices\" ") +
           (up ? "[0 1 2 0 2 3]" : "[0 2 1 0 3 2]") +
           " \"point3 P\" [-1 0 -1  -1 0 1  1 0 1  1 0 -1]" +
           (normals.empty() ? "" : " \"normal N\" [" + normals + "]") + "\n";
}
/// Normals that all lean by this angle from up, or from down, towards +x.
inline std::string leaning(double degrees, bool up = true) {
    double a = degrees * 3.14159265358979 / 180, y = up ? std::cos(a) : -std::cos(a);
    std::string one = format("%g %g 0 ", std::sin(a), y);
    return one + one + one + one;
}
inline std::string ball(double radius) {
    return format("Shape \"sphere\" \"float radius\" %g\n", radius);
}

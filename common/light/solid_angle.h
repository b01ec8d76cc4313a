// Directions into a cone or a spherical triangle, all equally likely per solid angle. What draws
// them takes the functions of angles in double: in float their last bit differs between libraries.
#pragma once
#include "common/base/vec.h"

/// 1 - cos of a cone's half angle from sin^2, without cancellation for narrow cones.
inline float one_minus_cos(float sin2) { return sin2 / (1 + std::sqrt(std::max(0.0f, 1 - sin2))); }

/// A direction of the cone around +z whose half angle has sin^2 = sin2.
///
///   cos = 1 - u1 (1 - cos_max);      pdf_w = 1 / (2 pi (1 - cos_max))
inline Vec3 sample_cone(float sin2, Vec2 u) {
    float h = u.x * one_minus_cos(sin2);
    float r = std::sqrt(std::max(0.0f, h * (2 - h)));
    return from_cylindrical(r, u.y, 1 - h);
}
inline float pdf_cone(float sin2) { return 1 / (2 * pi * one_minus_cos(sin2)); }
inline Vec2 invert_cone(float sin2, Vec3 w) {
    float phi = std::atan2(w.y, w.x);
    return {(1 - w.z) / one_minus_cos(sin2), (phi < 0 ? phi + 2 * pi : phi) / (2 * pi)};
}

/// Solid angle of the triangle with corners in the unit directions a, b, c; in sr, up to 2 pi.
///
///   tan(Omega / 2) = |a . (b x c)| / (1 + a.b + b.c + c.a)
///
/// From differences of the corners, so that a small triangle keeps its digits.
/// source  Van Oosterom, Strackee 1983
inline float triangle_solid_angle(Vec3 a, Vec3 b, Vec3 c) {
    float volume = std::abs(dot(a, cross(b - a, c - a)));
    float cosines = 1 + dot(a, b) + dot(b, c) + dot(c, a);
    return 2 * static_cast<float>(std::atan2(double{volume}, double{cosines}));
}

/// A direction of the spherical triangle a, b, c of solid angle `omega`.
///
///   u1 cuts off a sub-triangle a, b, c' of solid angle s = u1 omega; u2 goes from b towards c'
///   tan(|ac'| / 2) = sin(s / 2) / (tan(|ab| / 2) sin(alpha - s / 2)),  alpha: the angle at a
///
/// pdf_w = 1 / omega. The corners must not lie on one great circle.
/// source  Arvo 1995; c' from the spherical excess of two sides and the angle between them
/// tested by  "density: spherical triangle"
inline Vec3 sample_spherical_triangle(Vec3 a, Vec3 b, Vec3 c, float omega, Vec2 u) {
    // The corner c' on the edge from a to c that leaves the wanted solid angle. The normals of ab
    // and ac have alpha between them, and a cross product as long as the volume of a, b, c.
    Vec3 n_ab = cross(a, b - a), n_ac = cross(a, c - a);
    float volume = std::abs(dot(a, cross(b - a, c - a))), s = u.x * omega;
    float sin_s = static_cast<float>(std::sin(double{s / 2}));
    float cos_s = static_cast<float>(std::cos(double{s / 2}));
    float both = std::sqrt(length_squared(n_ab) * length_squared(n_ac));
    float tan_ab = std::sqrt(length_squared(b - a) / length_squared(b + a));  // tan(|ab| / 2)
    float t = sin_s * both / (tan_ab * (volume * cos_s - dot(n_ab, n_ac) * sin_s));
    Vec3 towards_c = normalize(c - dot(c, a) * a);
    Vec3 c_cut = ((1 - t * t) * a + 2 * t * towards_c) / (1 + t * t);

    // A point between b and c', by the area of the cap around b.
    float h = u.y * length_squared(c_cut - b) / 2;
    Vec3 from_b = c_cut - dot(c_cut, b) * b;
    float r = length(from_b);
    if (r == 0) return b;
    return (1 - h) * b + (std::sqrt(std::max(0.0f, h * (2 - h))) / r) * from_b;
}
inline float pdf_spherical_triangle(float omega) { return 1 / omega; }
inline Vec2 invert_spherical_triangle(Vec3 a, Vec3 b, Vec3 c, float omega, Vec3 w) {
    // The corner c' in which the arc from b through w ends.
    Vec3 c_cut = normalize(cross(cross(b, w - b), cross(a, c - a)));
    if (dot(c_cut, a + c) < 0) c_cut = -c_cut;
    float u1 = triangle_solid_angle(a, b, c_cut) / omega;
    return {u1, length_squared(w - b) / length_squared(c_cut - b)};
}

// Directions into a cone or a spherical triangle, all equally likely per solid angle.
#pragma once
#include "common/vec.h"

/// 1 - cos of a cone's half angle from sin^2, without cancellation for narrow cones.
inline float one_minus_cos(float sin2) { return sin2 / (1 + std::sqrt(std::max(0.0f, 1 - sin2))); }

/// A direction of the cone around +z whose half angle has sin^2 = sin2.
///
///   cos = 1 - u1 (1 - cos_max);      pdf_w = 1 / (2 pi (1 - cos_max))
inline Vec3 sample_cone(float sin2, Vec2 u) {
    float h = u.x * one_minus_cos(sin2), phi = 2 * pi * u.y;
    float r = std::sqrt(std::max(0.0f, h * (2 - h)));
    return {r * std::cos(phi), r * std::sin(phi), 1 - h};
}
inline float pdf_cone(float sin2) { return 1 / (2 * pi * one_minus_cos(sin2)); }
inline Vec2 invert_cone(float sin2, Vec3 w) {
    float phi = std::atan2(w.y, w.x);
    return {(1 - w.z) / one_minus_cos(sin2), (phi < 0 ? phi + 2 * pi : phi) / (2 * pi)};
}

/// Solid angle of the triangle with corners in the unit directions a, b, c; in sr, below 2 pi.
///
///   tan(Omega / 2) = |a . (b x c)| / (1 + a.b + b.c + c.a)
///
/// source  Van Oosterom, Strackee 1983
inline float triangle_solid_angle(Vec3 a, Vec3 b, Vec3 c) {
    float volume = std::abs(dot(a, cross(b, c)));
    return 2 * std::atan2(volume, 1 + dot(a, b) + dot(b, c) + dot(c, a));
}

/// A direction of the spherical triangle a, b, c of solid angle `omega`.
///
///   u1 cuts off a sub-triangle a, b, c' of solid angle u1 omega; u2 goes from b towards c'
///
/// pdf_w = 1 / omega. The corners must not lie on one great circle.
/// source  Arvo 1995      tested by  "density: spherical triangle"
inline Vec3 sample_spherical_triangle(Vec3 a, Vec3 b, Vec3 c, float omega, Vec2 u) {
    // The angle alpha at corner a.
    Vec3 n_ab = normalize(cross(a, b)), n_ca = normalize(cross(c, a));
    float cos_alpha = std::clamp(-dot(n_ab, n_ca), -1.0f, 1.0f);
    float sin_alpha = length(cross(n_ab, n_ca));

    // The corner c' on the edge from a to c that leaves the wanted solid angle.
    float s = u.x * omega, sin_s = std::sin(s), cos_s = std::cos(s);
    float sin_phi = cos_s * sin_alpha - sin_s * cos_alpha;
    float cos_phi = -cos_s * cos_alpha - sin_s * sin_alpha;
    float k1 = cos_phi + cos_alpha, k2 = sin_phi - sin_alpha * dot(a, b);
    float below = (k2 * sin_phi + k1 * cos_phi) * sin_alpha;
    float cos_b = below == 0 ? 1 : (k2 + (k2 * cos_phi - k1 * sin_phi) * cos_alpha) / below;
    cos_b = std::clamp(cos_b, -1.0f, 1.0f);
    Vec3 towards_c = normalize(c - dot(c, a) * a);
    Vec3 c_cut = cos_b * a + std::sqrt(1 - cos_b * cos_b) * towards_c;

    // A point between b and c', by the area of the cap around b.
    float h = u.y * (1 - dot(c_cut, b));
    Vec3 from_b = c_cut - dot(c_cut, b) * b;
    float r = length(from_b);
    if (r == 0) return b;
    return (1 - h) * b + (std::sqrt(std::max(0.0f, h * (2 - h))) / r) * from_b;
}

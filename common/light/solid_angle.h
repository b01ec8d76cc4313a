// Uniformly distributed directions in a cone or a spherical triangle. Trigonometric functions are
// computed in double: in float their last bit differs between libraries.
#pragma once
#include "common/base/vec.h"

/// 1 - cos of a cone's half angle from sin^2, without cancellation for narrow cones.
inline float one_minus_cos(float sin2) { return sin2 / (1 + std::sqrt(std::max(0.0f, 1 - sin2))); }

/// A uniform direction in the cone around +z whose half angle has sin^2 = sin2.
///
///   cos = 1 - u1 (1 - cos_max);      pdf_w = 1 / (2 pi (1 - cos_max))
inline Vec3 sample_cone(float sin2, Vec2 u) {
    float h = u.x * one_minus_cos(sin2);
    float r = std::sqrt(std::max(0.0f, h * (2 - h)));
    return from_cylindrical(r, u.y, 1 - h);
}
inline float pdf_cone(float sin2) { return 1 / (2 * pi * one_minus_cos(sin2)); }

/// Solid angle of the triangle with corners in the unit directions a, b, c; in sr, up to 2 pi.
///
///   tan(Omega / 2) = |a . (b x c)| / (1 + a.b + b.c + c.a)
///
/// In double: very near a triangle, or where it is seen edge-on, the result is a small difference
/// of large numbers.
/// source  Van Oosterom, Strackee 1983
/// tested by  "truth: solid angles of triangles and rectangles"
inline double triangle_solid_angle(Vec3d a, Vec3d b, Vec3d c) {
    double volume = std::abs(dot(b, cross(a, c)));
    return 2 * std::atan2(volume, 1 + dot(a, b) + dot(b, c) + dot(a, c));
}

/// A uniform direction in the spherical triangle a, b, c of solid angle `omega`.
///
///   u1 cuts off a sub-triangle a, b, c' of solid angle s = u1 omega; u2 goes from b towards c'
///   tan(|ac'| / 2) = sin(s / 2) / (tan(|ab| / 2) sin(alpha - s / 2)),  alpha: the angle at a
///
/// pdf_w = 1 / omega. The corners must not lie on one great circle.
/// source  Arvo 1995; c' from the spherical excess of two sides and the angle between them
/// tested by  "density: directions in cones and triangles"
inline Vec3d sample_spherical_triangle(Vec3d a, Vec3d b, Vec3d c, double omega, Vec2 u) {
    // The corner c' on the edge from a to c that leaves the wanted solid angle:
    // tan(|ac'| / 2) = y / x, both sides of the formula above times |ab| |ac|.
    Vec3d n_ac = cross(a, c), sum_ab = a + b;
    double volume = std::abs(dot(b, n_ac)), sin_ac = std::sqrt(dot(n_ac, n_ac)), cos_ac = dot(a, c);
    double half = double{u.x} * omega / 2, sine = std::sin(half), cosine = std::cos(half);
    double y = sine * sin_ac * dot(sum_ab, sum_ab) / 2;  // sum_ab^2 / 2 = 1 + cos |ab|
    double x = volume * cosine - (dot(b, c) - cos_ac * dot(a, b)) * sine;
    Vec3d towards_c = (1 / sin_ac) * (c - cos_ac * a);
    Vec3d c_cut = (1 / (x * x + y * y)) * ((x * x - y * y) * a + 2 * x * y * towards_c);

    // A point between b and c', by the area of the cap around b.
    Vec3d b_to_c = c_cut - b, from_b = c_cut - dot(c_cut, b) * b;
    double h = double{u.y} * dot(b_to_c, b_to_c) / 2, r2 = dot(from_b, from_b);
    if (r2 == 0) return b;
    return (1 - h) * b + std::sqrt(std::max(0.0, h * (2 - h)) / r2) * from_b;
}

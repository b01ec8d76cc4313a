// Affine transforms, in double: a scene file multiplies many of them before one point is moved.
#pragma once
#include <cmath>
#include <numbers>

#include "common/base/vec.h"

/// The map p -> x p.x + y p.y + z p.z + o: where it takes the three axes, and the origin.
struct Transform {
    Vec3d x = {1, 0, 0}, y = {0, 1, 0}, z = {0, 0, 1}, o = {0, 0, 0};
    bool operator==(const Transform&) const = default;
};

inline Vec3d transform_vector(const Transform& t, Vec3d v) {
    return v.x * t.x + v.y * t.y + v.z * t.z;
}
inline Vec3d transform_point(const Transform& t, Vec3d p) { return transform_vector(t, p) + t.o; }

/// a * b: b acts first.
inline Transform operator*(const Transform& a, const Transform& b) {
    return {transform_vector(a, b.x), transform_vector(a, b.y), transform_vector(a, b.z),
            transform_point(a, b.o)};
}

/// The factor of volumes; negative when the transform mirrors, 0 when it has no inverse.
inline double determinant(const Transform& t) { return dot(cross(t.x, t.y), t.z); }

/// How a normal is carried along: at right angles to the carried surface, on the carried side.
///
///   n -> (M^-1)^T n |det M|^(1/3)        the last factor keeps the length under uniform scaling
inline Vec3d transform_normal(const Transform& t, Vec3d n) {
    double det = determinant(t), factor = std::cbrt(std::abs(det)) / det;
    return factor * (n.x * cross(t.y, t.z) + n.y * cross(t.z, t.x) + n.z * cross(t.x, t.y));
}

inline Transform inverse(const Transform& t) {
    double det = determinant(t);
    Vec3d a = cross(t.y, t.z) / det, b = cross(t.z, t.x) / det, c = cross(t.x, t.y) / det;
    Transform result = {{a.x, b.x, c.x}, {a.y, b.y, c.y}, {a.z, b.z, c.z}, {}};
    result.o = -1 * transform_vector(result, t.o);
    return result;
}

inline Transform translation(Vec3d o) { return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, o}; }
inline Transform scaling(Vec3d s) { return {{s[0], 0, 0}, {0, s[1], 0}, {0, 0, s[2]}, {0, 0, 0}}; }

/// Turns by `degrees` around `axis` (of any length), counter-clockwise as seen against it.
///
///   v -> cos v + sin (a x v) + (1 - cos) (a . v) a        source  Rodrigues
inline Transform rotation(double degrees, Vec3d axis) {
    Vec3d a = normalize(axis);
    double radians = degrees * std::numbers::pi / 180;
    double c = std::cos(radians), s = std::sin(radians);
    auto turn = [&](Vec3d v) { return c * v + s * cross(a, v) + (1 - c) * dot(a, v) * a; };
    return {turn({1, 0, 0}), turn({0, 1, 0}), turn({0, 0, 1}), {0, 0, 0}};
}

/// World from camera for a camera at `eye` that looks at `look`: x right, y up, z forward, which
/// is a left-handed frame. Not finite when `up` is parallel to the view.
inline Transform look_at(Vec3d eye, Vec3d look, Vec3d up) {
    Vec3d forward = normalize(look - eye);
    Vec3d right = normalize(cross(normalize(up), forward));
    return {right, cross(forward, right), forward, eye};
}

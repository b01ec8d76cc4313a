// Affine transforms, in double: a scene file multiplies many of them before one point is moved.
#pragma once
#include <array>
#include <cmath>
#include <concepts>

#include "common/base/vec.h"

using Double3 = std::array<double, 3>;

inline Double3 to_double3(Vec3 a) { return {double{a.x}, double{a.y}, double{a.z}}; }
inline Vec3 to_vec3(const Double3& a) {
    return {static_cast<float>(a[0]), static_cast<float>(a[1]), static_cast<float>(a[2])};
}
inline double dot(const Double3& a, const Double3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Double3 cross(const Double3& a, const Double3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline Double3 operator+(const Double3& a, const Double3& b) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline Double3 operator-(const Double3& a, const Double3& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Double3 operator*(double s, const Double3& a) { return {s * a[0], s * a[1], s * a[2]}; }
inline double length(const Double3& a) { return std::hypot(a[0], a[1], a[2]); }
/// A template, so that normalize({x, y, z}) is that of a Vec3.
template <std::same_as<Double3> T>
T normalize(const T& a) {
    double l = length(a);
    return {a[0] / l, a[1] / l, a[2] / l};
}

/// The map p -> x p.x + y p.y + z p.z + o: where it takes the three axes, and the origin.
struct Transform {
    Double3 x = {1, 0, 0}, y = {0, 1, 0}, z = {0, 0, 1}, o = {0, 0, 0};
    bool operator==(const Transform&) const = default;
};

inline Double3 transform_vector(const Transform& t, const Double3& v) {
    Double3 result;
    for (size_t i = 0; i < 3; i++) result[i] = t.x[i] * v[0] + t.y[i] * v[1] + t.z[i] * v[2];
    return result;
}
inline Double3 transform_point(const Transform& t, const Double3& p) {
    Double3 v = transform_vector(t, p);
    return {v[0] + t.o[0], v[1] + t.o[1], v[2] + t.o[2]};
}

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
inline Double3 transform_normal(const Transform& t, const Double3& n) {
    double det = determinant(t), factor = std::cbrt(std::abs(det)) / det;
    Double3 a = cross(t.y, t.z), b = cross(t.z, t.x), c = cross(t.x, t.y), result;
    for (size_t i = 0; i < 3; i++) {
        result[i] = factor * (a[i] * n[0] + b[i] * n[1] + c[i] * n[2]);
    }
    return result;
}

inline Transform inverse(const Transform& t) {
    double det = determinant(t);
    Double3 a = cross(t.y, t.z), b = cross(t.z, t.x), c = cross(t.x, t.y);
    Transform result;
    result.x = {a[0] / det, b[0] / det, c[0] / det};
    result.y = {a[1] / det, b[1] / det, c[1] / det};
    result.z = {a[2] / det, b[2] / det, c[2] / det};
    Double3 o = transform_vector(result, t.o);
    result.o = {-o[0], -o[1], -o[2]};
    return result;
}

inline Transform translation(const Double3& o) { return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, o}; }
inline Transform scaling(const Double3& s) {
    return {{s[0], 0, 0}, {0, s[1], 0}, {0, 0, s[2]}, {0, 0, 0}};
}

/// Turns by `degrees` around `axis` (of any length), counter-clockwise as seen against it.
///
///   v -> cos v + sin (a x v) + (1 - cos) (a . v) a        source  Rodrigues
inline Transform rotation(double degrees, const Double3& axis) {
    Double3 a = normalize(axis);
    double radians = degrees * std::numbers::pi / 180;
    double c = std::cos(radians), s = std::sin(radians);
    auto turn = [&](const Double3& v) {
        Double3 w = cross(a, v), result;
        for (size_t i = 0; i < 3; i++) {
            result[i] = c * v[i] + s * w[i] + (1 - c) * dot(a, v) * a[i];
        }
        return result;
    };
    return {turn({1, 0, 0}), turn({0, 1, 0}), turn({0, 0, 1}), {0, 0, 0}};
}

/// World from camera for a camera at `eye` that looks at `look`: x right, y up, z forward, which
/// is a left-handed frame. Not finite when `up` is parallel to the view.
inline Transform look_at(const Double3& eye, const Double3& look, const Double3& up) {
    Double3 forward = normalize(look - eye);
    Double3 right = normalize(cross(normalize(up), forward));
    return {right, cross(forward, right), forward, eye};
}

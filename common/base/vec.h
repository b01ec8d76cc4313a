// Points, directions, colors, and the local frame around a normal.
#pragma once
#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>
#include <numbers>

inline constexpr float pi = std::numbers::pi_v<float>;
inline constexpr float infinity = std::numeric_limits<float>::infinity();

struct Vec2 {
    float x = 0, y = 0;
};

/// A point or a direction.
template <typename T>
struct Vector3 {
    T x = 0, y = 0, z = 0;

    T operator[](auto axis) const { return (&x)[axis]; }
    T& operator[](auto axis) { return (&x)[axis]; }
    template <typename U>
    explicit operator Vector3<U>() const {
        return {static_cast<U>(x), static_cast<U>(y), static_cast<U>(z)};
    }
    bool operator==(const Vector3&) const = default;

    friend Vector3 operator-(Vector3 a) { return {-a.x, -a.y, -a.z}; }
    friend Vector3 operator+(Vector3 a, Vector3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend Vector3 operator-(Vector3 a, Vector3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend Vector3 operator*(T s, Vector3 a) { return {s * a.x, s * a.y, s * a.z}; }
    friend Vector3 operator*(Vector3 a, T s) { return s * a; }
    friend Vector3 operator/(Vector3 a, T s) { return {a.x / s, a.y / s, a.z / s}; }
    friend Vector3& operator+=(Vector3& a, Vector3 b) { return a = a + b; }

    friend T dot(Vector3 a, Vector3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
    friend Vector3 cross(Vector3 a, Vector3 b) {
        return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    }
};
using Vec3 = Vector3<float>;
using Vec3d = Vector3<double>;  // for where float loses too much

inline float length_squared(Vec3 a) { return dot(a, a); }
inline float length(Vec3 a) { return std::sqrt(dot(a, a)); }
inline Vec3 normalize(Vec3 a) { return (1 / length(a)) * a; }
inline Vec3 abs(Vec3 a) { return {std::abs(a.x), std::abs(a.y), std::abs(a.z)}; }
inline Vec3 min(Vec3 a, Vec3 b) {
    return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}
inline Vec3 max(Vec3 a, Vec3 b) {
    return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}
inline float max_component(Vec3 a) { return std::max({a.x, a.y, a.z}); }
inline bool is_finite(Vec3 a) {
    return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

inline Vec3 to_vec3(Vec3d a) { return Vec3(a); }
inline double length(Vec3d a) { return std::hypot(a.x, a.y, a.z); }
/// A template, so that normalize({x, y, z}) is that of a Vec3.
template <std::same_as<Vec3d> T>
T normalize(T a) {
    return a / length(a);
}

/// The point {r cos phi, r sin phi, z}, phi = 2 pi u: after the part u of a turn, 0 <= u <= 1.
///
/// Taylor's series around the nearest quarter turn, right to 1e-7, and without a branch: of a
/// random u the processor could not foresee it.
/// tested by  "density: uniform hemisphere"
inline Vec3 from_cylindrical(float r, float u, float z) {
    int quarter = static_cast<int>(4 * u + 0.5f);
    float x = 2 * pi * (u - 0.25f * static_cast<float>(quarter)), q = x * x;
    float s =
        x * (1 + q * (-1.0f / 6 + q * (1.0f / 120 + q * (-1.0f / 5040 + q * (1.0f / 362880)))));
    float c = 1 + q * (-1.0f / 2 + q * (1.0f / 24 + q * (-1.0f / 720 + q * (1.0f / 40320))));
    static constexpr float sines[] = {0, 1, 0, -1, 0};
    float sine = sines[quarter & 3], cosine = sines[(quarter & 3) + 1];
    return {r * (cosine * c - sine * s), r * (sine * c + cosine * s), z};
}

/// Radiance, reflectance or throughput in linear sRGB primaries.
template <typename T>
struct Color {
    T r = 0, g = 0, b = 0;

    operator Color<double>() const requires std::same_as<T, float> {
        return {double{r}, double{g}, double{b}};
    }
    bool operator==(const Color&) const = default;

    friend Color operator+(Color x, Color y) { return {x.r + y.r, x.g + y.g, x.b + y.b}; }
    friend Color operator-(Color x, Color y) { return {x.r - y.r, x.g - y.g, x.b - y.b}; }
    friend Color operator*(Color x, Color y) { return {x.r * y.r, x.g * y.g, x.b * y.b}; }
    friend Color operator*(T s, Color x) { return {s * x.r, s * x.g, s * x.b}; }
    friend Color operator*(Color x, T s) { return s * x; }
    friend Color operator/(Color x, T s) { return (1 / s) * x; }
    friend Color& operator+=(Color& x, Color y) { return x = x + y; }
    friend Color& operator*=(Color& x, Color y) { return x = x * y; }
    friend Color& operator*=(Color& x, T s) { return x = s * x; }
    friend Color& operator/=(Color& x, T s) { return x = x / s; }
};
using Rgb = Color<float>;
using Rgbd = Color<double>;  // for sums of many

inline float max_component(Rgb a) { return std::max({a.r, a.g, a.b}); }
inline float average(Rgb a) { return (a.r + a.g + a.b) * (1.0f / 3); }
inline bool is_black(Rgb a) { return a.r == 0 && a.g == 0 && a.b == 0; }
inline bool is_finite(Rgb a) {
    return std::isfinite(a.r) && std::isfinite(a.g) && std::isfinite(a.b);
}

/// x / y; 0 where y is 0.
inline Rgbd ratio(Rgbd x, Rgbd y) {
    return {y.r > 0 ? x.r / y.r : 0, y.g > 0 ? x.g / y.g : 0, y.b > 0 ? x.b / y.b : 0};
}
inline Rgbd min(Rgbd x, Rgbd y) {
    return {std::min(x.r, y.r), std::min(x.g, y.g), std::min(x.b, y.b)};
}
inline double sum_of(Rgbd x) { return x.r + x.g + x.b; }
inline double largest_of(Rgbd x) { return std::max({std::abs(x.r), std::abs(x.g), std::abs(x.b)}); }
inline Rgb to_rgb(Rgbd x) {
    return {static_cast<float>(x.r), static_cast<float>(x.g), static_cast<float>(x.b)};
}

/// An orthonormal, right-handed frame s, t, n around a unit vector n.
///
/// source  Duff et al. 2017, "Building an Orthonormal Basis, Revisited": no branch, and no
///         singularity at n.z = -1      tested by  "identity: the frame is orthonormal"
struct Frame {
    Vec3 s, t, n;

    explicit Frame(Vec3 normal) : n(normal) {
        float sign = std::copysign(1.0f, n.z);
        float a = -1 / (sign + n.z), b = n.x * n.y * a;
        s = {1 + sign * n.x * n.x * a, sign * b, -sign * n.x};
        t = {b, sign + n.y * n.y * a, -n.y};
    }
    Vec3 to_world(Vec3 v) const { return v.x * s + v.y * t + v.z * n; }
    Vec3 to_local(Vec3 v) const { return {dot(v, s), dot(v, t), dot(v, n)}; }
};

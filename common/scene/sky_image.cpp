#include "common/scene/sky_image.h"

#include "common/scene/intersect.h"

namespace {

// Computed in double: in float the last bit differs between libraries.
float sine_of(float x) { return static_cast<float>(std::sin(double{x})); }
float cosine_of(float x) { return static_cast<float>(std::cos(double{x})); }
float angle_of(float y, float x) { return static_cast<float>(std::atan2(double{y}, double{x})); }

/// The unit sphere from the unit square, equal areas for equal areas: the middle half (a diamond)
/// is the half above, folded out at the corners is the half below.      source  Clarberg 2008
Vec3 sphere_from_square(Vec2 uv) {
    float a = 2 * uv.x - 1, b = 2 * uv.y - 1;
    float inside = 1 - (std::abs(a) + std::abs(b));  // of the diamond; below 0 outside
    float r = 1 - std::abs(inside);
    float phi = (r == 0 ? 1 : (std::abs(b) - std::abs(a)) / r + 1) * (pi / 4);
    float sine = r * std::sqrt(2 - r * r);
    return {std::copysign(sine * cosine_of(phi), a), std::copysign(sine * sine_of(phi), b),
            std::copysign(1 - r * r, inside)};
}

Vec2 square_from_sphere(Vec3 w) {
    float r = std::sqrt(std::max(0.0f, 1 - std::abs(w.z)));
    float b = r * (2 / pi) * angle_of(std::abs(w.y), std::abs(w.x)), a = r - b;
    if (w.z < 0) {
        float inner = a;
        a = 1 - b, b = 1 - inner;
    }
    return {(std::copysign(a, w.x) + 1) / 2, (std::copysign(b, w.y) + 1) / 2};
}

}  // namespace

Vec3 direction_of(const SkyImage& sky, Vec2 uv) {
    Vec3 w;
    if (sky.map == SkyImage::Map::square) {
        w = sphere_from_square(uv);
    } else {
        float theta = pi * uv.y, phi = 2 * pi * uv.x;
        w = {sine_of(theta) * cosine_of(phi), sine_of(theta) * sine_of(phi), cosine_of(theta)};
    }
    return normalize(w.x * sky.x + w.y * sky.y + w.z * sky.z);
}

Vec2 point_of(const SkyImage& sky, Vec3 wi) {
    Vec3 w = {dot(wi, sky.x), dot(wi, sky.y), dot(wi, sky.z)};
    if (sky.map == SkyImage::Map::square) return square_from_sphere(w);
    float phi = angle_of(w.y, w.x), sine = std::sqrt(w.x * w.x + w.y * w.y);
    return {(phi < 0 ? phi + 2 * pi : phi) / (2 * pi), angle_of(sine, w.z) / pi};
}

Rgb sky_towards(const Scene& scene, Vec3 wi) {
    return scene.sky_image ? scene.sky_image->at(point_of(*scene.sky_image, wi)) : scene.sky;
}

float solid_angle_per_area(const SkyImage& sky, Vec2 uv) {
    if (sky.map == SkyImage::Map::square) return 4 * pi;
    return 2 * pi * pi * std::max(sine_of(pi * uv.y), 1e-20f);
}

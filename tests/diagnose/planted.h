// Which mistake is planted: included before all else in the copies that tests/diagnose/plant makes.
#pragma once

namespace planted {
inline int mistake = 0;                     // its number in rows.tsv; 0: none
inline bool cosine = false;                 // directions of chapters 07 and 09
inline bool sky = false;                    // it is sampled by the cosine
inline thread_local float sky_pdf = 0;      // by the cosine, of the direction sampled last
inline thread_local bool diffused = false;  // a diffuse surface has scattered this path
}  // namespace planted

#include "common/material/cosine.h"
#include "common/scene/intersect.h"

namespace planted {

inline Rgb inverse(Rgb c) {
    auto of = [](float x) { return x > 0 ? 1 / x : 0; };
    return {of(c.r), of(c.g), of(c.b)};
}
inline Vec2 half(Vec2 u) { return {u.x, u.y / 2}; }
inline Vec2 one(Vec2 u) { return {u.x, u.x}; }
inline Rgb clamped(Rgb c, float most) {
    return {std::min(c.r, most), std::min(c.g, most), std::min(c.b, most)};
}
/// Whether anything but glass (or a mirror) lies on the ray.
inline bool blocked(const Scene& scene, Ray ray, bool through_mirrors = false) {
    while (std::optional<Hit> x = intersect(scene, ray)) {
        MaterialType type = x->material->type;
        if (type == MaterialType::diffuse) return true;
        if (type == MaterialType::conductor && !through_mirrors) return true;
        ray = spawn_ray(*x, ray.d, ray.t_max - x->t);
    }
    return false;
}
/// One of the lights, but never the last one (or the first). sky_last: in a list that ends with it.
inline size_t all_but(const Scene& scene, float u, bool last, bool sky_last) {
    size_t N = scene.lights.size();
    if (N == 1) return 0;
    size_t i = std::min(static_cast<size_t>(u * static_cast<float>(N - 1)), N - 2) + !last;
    if (scene.sky_light < 0 || !sky_last) return i;
    size_t before = static_cast<size_t>(scene.sky_light);
    return i == N - 1 ? before : i + (i >= before);
}
/// A factor of the density of light at this distance, 1 to 5: no cosine, a second one, the distance
/// once, no distance, no area.
inline float wrong_density(const Scene& scene, size_t light, float d, float cos, int which) {
    float factors[] = {1, cos, 1 / cos, 1 / d, 1 / (d * d), scene.light_shapes[light].area};
    return factors[which];
}
/// The cosine at the light that a ray from x in direction wi meets.
inline float cosine_at(const Scene& scene, const Hit& x, Vec3 wi) {
    std::optional<Hit> y = intersect(scene, spawn_ray(x, wi));
    return y ? std::abs(dot(wi, y->ng)) : 1;
}

}  // namespace planted

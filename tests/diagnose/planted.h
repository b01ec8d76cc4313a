// Which mistake is planted: included before all else in the copies that tests/diagnose/plant makes.
#pragma once

namespace planted {
inline int mistake = 0;                     // its number in rows.tsv; 0: none
inline bool cosine = false;                 // directions of chapters 07 and 09
inline bool sky = false;                    // it is sampled by the cosine
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

}  // namespace planted

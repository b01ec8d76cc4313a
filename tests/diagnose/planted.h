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
/// The first (sign 1) or last (-1) object in the scene's list of all that lie on the ray.
inline std::optional<Hit> by_order(const Scene& scene, const Ray& ray, int sign) {
    auto number = [&](const Hit& x) {
        auto shape = [](const auto& prim) { return static_cast<int>(prim.shape); };
        return visit(scene.geometry, x.prim, shape, shape, shape);
    };
    std::optional<Hit> best;
    for (auto x = intersect(scene, ray); x; x = intersect(scene, spawn_ray(*x, ray.d)))
        if (!best || sign * number(*x) < sign * number(*best)) best = x;
    return best;
}
/// What a ray hits if spheres are hit from outside alone.
inline std::optional<Hit> outside(const Scene& scene, Ray ray) {
    auto from_inside = [&](const Hit& x) {
        auto no = [](const auto&) { return false; };
        return visit(
            scene.geometry, x.prim, no,
            [&](const Sphere& sphere) { return dot(ray.d, x.p - sphere.c) > 0; }, no);
    };
    std::optional<Hit> x = intersect(scene, ray);
    for (; x && from_inside(*x); x = intersect(scene, ray))
        ray = spawn_ray(*x, ray.d, ray.t_max - x->t);
    return x;
}
/// A point in a spherical lamp, not on it. How 2: its normal is shorter than 1; 0: it stays.
template <typename Point>
Point in_ball(const Scene& scene, size_t light, Point y, Vec2 u, int how) {
    if (how == 0 || scene.light_shapes[light].parallelogram) return y;
    Vec3 centre = scene.light_shapes[light].centre;
    float r = std::cbrt(u.x * 4096 - std::floor(u.x * 4096));
    y.p = centre + r * (y.p - centre);
    if (how == 2) y.n = r * y.n;
    return y;
}
/// A direction of half of the hemisphere: which half depends on how a frame is made from n.
template <typename Sample>
Sample half_turn(Sample s, Vec3 n, int frame) {
    static const Vec3 axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    static const int rules[3][2] = {{0, 1}, {1, 0}, {2, 0}};
    if (s.specular || frame < 0) return s;
    const int* rule = rules[frame / 4];
    Vec3 t = normalize(cross(axes[std::abs(n[rule[0]]) > 0.5f ? rule[1] : rule[0]], n));
    if (frame & 1) t = cross(n, t);
    float away = std::min(0.0f, frame & 2 ? -dot(s.wi, t) : dot(s.wi, t));
    s.wi = s.wi - (frame & 2 ? -2 : 2) * away * t;
    return s;
}

}  // namespace planted

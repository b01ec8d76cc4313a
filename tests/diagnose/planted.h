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
/// What is wrong in plainly().
enum Slip { none, one_edge, length_alone, four_ac, triangle, radius, far_side, no_unit_normals };
/// What many renderers find on a ray, in the simplest way: a quad by its plane and two coordinates,
/// a sphere by the quadratic formula for directions of length 1. Nothing counts before `margin`.
template <typename Real>
std::optional<Hit> plainly(const Scene& scene, const Ray& ray, Real margin, Slip slip = none) {
    const Geometry& g = scene.geometry;
    std::optional<Hit> best;
    Real t_max = static_cast<Real>(ray.t_max);
    auto product = [](Vec3 a, Vec3 b) {
        Real sum = 0;
        for (int k = 0; k < 3; k++) sum += static_cast<Real>(a[k]) * static_cast<Real>(b[k]);
        return sum;
    };
    auto accept = [&](Real t, Vec3 n, const Sphere* sphere, uint32_t shape, size_t prim) {
        Vec3 p = ray.o + static_cast<float>(t) * ray.d;
        if (sphere) n = (p - sphere->c) / (slip == no_unit_normals ? 1 : sphere->r);
        bool front = dot(ray.d, n) < 0;
        best = Hit{p,
                   front ? n : -n,
                   front ? n : -n,
                   0,
                   static_cast<float>(t),
                   ray.time,
                   &scene.materials[scene.shapes[shape].material],
                   front != scene.shapes[shape].reverse,
                   scene.shapes[shape].light,
                   static_cast<uint32_t>(prim)};
        t_max = t;
    };
    for (size_t i = 0; i < g.triangles.size(); i++)
        for (size_t k = 0; k < g.triangles.size(); k++) {
            const Triangle &one = g.triangles[i], &two = g.triangles[k];  // 0 1 2 and 0 2 3
            if (one.shape != two.shape || one.v[2] != two.v[1] || one.v[0] != two.v[0]) continue;
            Vec3 o = g.positions[one.v[0]], u = g.positions[one.v[1]] - o;
            Vec3 v = g.positions[two.v[2]] - o, n = normalize(cross(u, v));
            Real t = product(o - ray.o, n) / product(ray.d, n);
            Vec3 p = ray.o - o + static_cast<float>(t) * ray.d;
            float uu = dot(u, u), vv = slip == one_edge ? uu : dot(v, v);
            if (slip == length_alone) uu = std::sqrt(uu), vv = std::sqrt(vv);
            float a = dot(p, u) / uu, b = dot(p, v) / vv, most = slip == triangle ? 1 - a : 1;
            if (t > margin && t < t_max && a >= 0 && a <= 1 && b >= 0 && b <= most)
                accept(t, n, nullptr, one.shape, i);
        }
    for (size_t i = 0; i < g.spheres.size(); i++) {
        const Sphere& s = g.spheres[i];
        Vec3 q = ray.o - s.c;
        Real r = static_cast<Real>(s.r), b = product(q, ray.d);
        Real c = product(q, q) - (slip == radius ? r : r * r);
        Real h = b * b - (slip == four_ac ? 4 : 1) * c;
        if (h < 0) continue;
        Real t = -b - std::sqrt(h);
        if (t <= margin || slip == far_side) t = -b + std::sqrt(h);
        if (t > margin && t < t_max) accept(t, {}, &s, s.shape, g.triangles.size() + i);
    }
    return best;
}
/// The distance to the point of a light at about this distance, computed from the point.
inline float length_to(const Scene& scene, const Hit& x, Vec3 wi, float about) {
    std::optional<Hit> y = plainly<float>(scene, Ray{x.p, wi, about * 1.00001f}, about * 0.99999f);
    return y ? length(y->p - x.p) : about;
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
/// The ray through one point of the pixel through which this one goes; (0,0): its upper left
/// corner.
inline Ray through(const Scene& scene, Ray ray, Vec2 at) {
    const Camera& c = scene.camera;
    float half = std::tan(c.fov * pi / 360), w = static_cast<float>(scene.width);
    float h = static_cast<float>(scene.height), shorter = std::min(w, h);
    float z = dot(ray.d, c.forward);
    float x = (dot(ray.d, c.right) / z / half * shorter + w) / 2;
    float y = (h - dot(ray.d, c.up) / z / half * shorter) / 2;
    x = std::floor(x) + at.x, y = std::floor(y) + at.y;
    ray.d = normalize(c.forward + ((2 * x - w) / shorter * half) * c.right +
                      ((h - 2 * y) / shorter * half) * c.up);
    return ray;
}
/// The ray through the same point of the film, if the camera's vectors are wrong where it looks up
/// or down. 1: right = up x forward is not normalised, up = forward x right neither; 2: up is; 3:
/// up is that of the file.
inline Ray skewed(const Scene& scene, Ray ray, int how) {
    const Camera& c = scene.camera;
    float z = dot(ray.d, c.forward);
    Vec3 up = std::abs(c.up.y) > std::abs(c.up.z) ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
    float length_of_right = length(cross(up, c.forward));
    Vec3 right = (how == 3 ? 1 : length_of_right) * c.right;
    if (how != 3) up = (how == 1 ? length_of_right : 1) * c.up;
    ray.d = normalize(c.forward + dot(ray.d, c.right) / z * right + dot(ray.d, c.up) / z * up);
    return ray;
}
/// Glass whose normal is not turned to the side of the ray. inverted: eta is, inside.
template <typename Sample>
Sample not_turned(const Hit& x, Vec3 wo, float u, bool inverted) {
    Vec3 n = x.front ? x.n : -x.n;
    float eta = x.front || !inverted ? x.material->ior : 1 / x.material->ior, cos = dot(wo, n);
    float k = 1 - (1 - cos * cos) / (eta * eta), cos_t = std::sqrt(std::max(k, 0.0f));
    float s = (cos - eta * cos_t) / (cos + eta * cos_t),
          p = (eta * cos - cos_t) / (eta * cos + cos_t);
    float R = k <= 0 ? 1 : (s * s + p * p) / 2;
    Vec3 wi = u < R ? 2 * cos * n - wo : normalize((cos / eta - cos_t) * n - wo / eta);
    float f = (u < R ? 1 : 1 / (eta * eta)) / std::abs(dot(wi, x.n));
    return {wi, {f, f, f}, 1, true};
}
/// A point in a spherical lamp, not on it. How 2: its normal is shorter than 1; 3: at a distance of
/// 1 from the centre; 0: it stays.
template <typename Point>
Point in_ball(const Scene& scene, size_t light, Point y, Vec2 u, int how) {
    if (how == 0 || scene.light_shapes[light].parallelogram) return y;
    Vec3 centre = scene.light_shapes[light].centre;
    float r = std::cbrt(u.x * 4096 - std::floor(u.x * 4096));
    if (how == 3) r = 1 / length(y.p - centre);
    y.p = centre + r * (y.p - centre);
    if (how == 2) y.n = r * y.n;
    return y;
}
/// The first axis of a frame around n: renderers choose it in different ways (frame: 0 to 11).
inline Vec3 axis_of(Vec3 n, int frame) {
    static const Vec3 axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    static const int rules[3][2] = {{0, 1}, {1, 0}, {2, 0}};
    const int* rule = rules[frame / 4];
    Vec3 t = normalize(cross(axes[std::abs(n[rule[0]]) > 0.5f ? rule[1] : rule[0]], n));
    return frame & 1 ? cross(n, t) : t;
}
/// A direction whose angle around n comes from the number that its angle to n came from.
template <typename Sample>
Sample spiral(Sample s, Vec3 n, int frame) {
    if (s.specular || frame < 0) return s;
    float z = dot(s.wi, n), r = std::sqrt(std::max(0.0f, 1 - z * z)), phi = 2 * pi * r * r;
    Vec3 t = axis_of(n, frame), b = cross(n, t);
    s.wi = r * std::cos(phi) * t + (frame & 2 ? -r : r) * std::sin(phi) * b + z * n;
    return s;
}
/// A direction of half of the hemisphere: which half depends on the frame.
template <typename Sample>
Sample half_turn(Sample s, Vec3 n, int frame) {
    if (s.specular || frame < 0) return s;
    Vec3 t = axis_of(n, frame);
    float away = std::min(0.0f, frame & 2 ? -dot(s.wi, t) : dot(s.wi, t));
    s.wi = s.wi - (frame & 2 ? -2 : 2) * away * t;
    return s;
}

}  // namespace planted

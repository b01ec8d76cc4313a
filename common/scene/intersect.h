// What a ray meets, ready for shading, and how to leave a surface without meeting it again.
#pragma once
#include <optional>
#include <vector>

#include "common/base/ray_count.h"
#include "common/material/hit.h"
#include "common/scene/scene.h"

// The hierarchy, without the header that says how it is made.
PrimHit closest_hit(const Bvh& bvh, const Geometry& geometry, const Ray& ray);
bool any_hit(const Bvh& bvh, const Geometry& geometry, const Ray& ray);

/// A ray that was traced: in search of the nearest surface, or as a shadow ray, of anything.
struct TracedRay {
    Ray ray;
    bool shadow, met;
    float t;  // where it met the nearest surface
};

/// Where this thread keeps the rays that it traces; null: nowhere. Who explains a path asks.
inline constinit thread_local std::vector<TracedRay>* rays_kept = nullptr;

namespace hit_details {

inline uint32_t finish(const Geometry& g, const Triangle& tri, const PrimHit& found, Hit& x) {
    Vec3 p0 = g.positions[tri.v[0]], p1 = g.positions[tri.v[1]], p2 = g.positions[tri.v[2]];
    float b0 = 1 - found.b1 - found.b2;
    x.p = b0 * p0 + found.b1 * p1 + found.b2 * p2;
    x.eps = rounding_error(max_component(b0 * abs(p0) + found.b1 * abs(p1) + found.b2 * abs(p2)));
    x.n = x.ng = g.facet_normals[found.prim];
    if (!g.normals.empty()) {
        Vec3 n = b0 * g.normals[tri.v[0]] + found.b1 * g.normals[tri.v[1]] +
                 found.b2 * g.normals[tri.v[2]];
        if (dot(n, n) > 0) x.n = normalize(n);
    }
    return tri.shape;
}

inline uint32_t finish(const Sphere& sphere, Vec3 p, Hit& x) {
    x.n = x.ng = normalize(p - sphere.c);
    x.p = sphere.c + sphere.r * x.ng;
    x.eps = rounding_error(max_component(abs(sphere.c)) + sphere.r);
    return sphere.shape;
}

inline uint32_t finish(const Disk& disk, Vec3 p, Hit& x) {
    x.n = x.ng = disk.n;
    x.p = p - dot(p - disk.c, disk.n) * disk.n;
    x.eps = rounding_error(max_component(abs(disk.c)) + disk.r);
    return disk.shape;
}

/// Turns the normal of what is met edge-on towards the ray, so that no cosine is 0.
[[gnu::noinline]] inline float tilt(const Ray& ray, Vec3& n) {
    n = normalize(n - 0x1p-20f * normalize(ray.d));
    return dot(ray.d, n);
}

}  // namespace hit_details

/// Puts x where the ray meets the primitive found, with the normals that the surface has there, and
/// returns its shape. In its place: a copy would have to wait until all parts are in memory.
inline const Shape& place_hit(const Scene& scene, const Geometry& g, const Ray& ray,
                              const PrimHit& found, Hit& x) {
    uint32_t shape = visit(
        g, found.prim,
        [&](const Triangle& triangle) { return hit_details::finish(g, triangle, found, x); },
        [&](const Sphere& sphere) {
            return hit_details::finish(sphere, ray.o + found.t * ray.d, x);
        },
        [&](const Disk& disk) { return hit_details::finish(disk, ray.o + found.t * ray.d, x); });
    return scene.shapes[shape];
}

/// Turns the normals to the side that the ray came from, and fills in the rest but for the texture.
inline void finish_hit(const Scene& scene, const Shape& shape, const Ray& ray, const PrimHit& found,
                       Hit& x) {
    float away = dot(ray.d, x.ng);
    if (away == 0) [[unlikely]]
        away = hit_details::tilt(ray, x.ng);
    x.front = away < 0;
    if (shape.reverse) x.front = !x.front;
    if (away > 0) x.ng = -x.ng;
    if (dot(x.n, x.ng) < 0) x.n = -x.n;
    if (dot(ray.d, x.n) >= 0) x.n = x.ng;  // a smoothed normal that looks away cannot be used

    x.t = found.t;
    x.time = ray.time;
    x.material = &scene.materials[shape.material];
    x.light = shape.light;
    x.prim = found.prim;
}

/// Gives x, a point of the primitive that was found, the reflectance that its texture has there.
void look_up_texture(const Scene& scene, const Geometry& g, const PrimHit& found, Hit& x);

/// Fills in all of x.
inline void make_hit(const Scene& scene, const Ray& ray, const PrimHit& found, Hit& x) {
    finish_hit(scene, place_hit(scene, scene.geometry, ray, found, x), ray, found, x);
    if (x.material->texture != 0) look_up_texture(scene, scene.geometry, found, x);
}

namespace hit_details {

/// What few scenes have: the reflectance of a texture, and shapes that move.
void vary_or_move(const Scene& scene, const Ray& ray, const PrimHit& found, std::optional<Hit>& x);
bool occluded_by_movers(const Scene& scene, const Ray& ray);

inline std::optional<Hit> nearest(const Scene& scene, const Ray& ray) {
    PrimHit found = closest_hit(*scene.bvh, scene.geometry, ray);
    std::optional<Hit> x;
    if (found.prim != PrimHit::none) {
        x.emplace();
        finish_hit(scene, place_hit(scene, scene.geometry, ray, found, *x), ray, found, *x);
    }
    if (scene.moves_or_varies) [[unlikely]]
        vary_or_move(scene, ray, found, x);
    return x;
}
inline bool any(const Scene& scene, const Ray& ray) {
    if (any_hit(*scene.bvh, scene.geometry, ray)) return true;
    return scene.moves && occluded_by_movers(scene, ray);
}

/// nearest() and any() that keep the ray as well: apart, so that they cost nothing when nobody
/// asks.
std::optional<Hit> nearest_kept(const Scene& scene, Ray ray);
bool any_kept(const Scene& scene, Ray ray);

}  // namespace hit_details

/// The nearest surface along the ray, if there is one.
inline std::optional<Hit> intersect(const Scene& scene, const Ray& ray) {
    rays_traced++;
    if (rays_kept) [[unlikely]]
        return hit_details::nearest_kept(scene, ray);
    return hit_details::nearest(scene, ray);
}

/// Whether anything lies on the ray before t_max.
inline bool occluded(const Scene& scene, const Ray& ray) {
    rays_traced++;
    if (rays_kept) [[unlikely]]
        return hit_details::any_kept(scene, ray);
    return hit_details::any(scene, ray);
}

/// A ray from x in direction wi that starts just off the surface, on the side it leaves to.
inline Ray spawn_ray(const Hit& x, Vec3 wi, float t_max = infinity) {
    float side = dot(wi, x.ng) < 0 ? -x.eps : x.eps;
    return {x.p + side * x.ng, wi, t_max, x.time, x.prim};
}

/// Le at x towards where the ray came from.
inline Rgb emission(const Scene& scene, const Hit& x) {
    if (x.light < 0) return {};
    const Light& light = scene.lights[static_cast<size_t>(x.light)];
    return x.front || light.two_sided ? light.L : Rgb{};
}
/// The radiance of the sky in direction wi.
Rgb image_towards(const SkyImage& sky, Vec3 wi);
inline Rgb sky_towards(const Scene& scene, Vec3 wi) {
    return scene.sky_image ? image_towards(*scene.sky_image, wi) : scene.sky;
}

// What a ray meets, ready for shading, and how to leave a surface without meeting it again.
#pragma once
#include <optional>
#include <vector>

#include "common/material/hit.h"
#include "common/scene/scene.h"

/// A ray that was traced: in search of the nearest surface, or as a shadow ray, of anything.
struct TracedRay {
    Ray ray;
    bool shadow, met;
    float t;  // where it met the nearest surface
};

/// Where this thread keeps the rays that it traces; null: nowhere. Who explains a path asks.
inline constinit thread_local std::vector<TracedRay>* rays_kept = nullptr;

/// Makes x the point where the ray meets the primitive found, ready for shading.
void make_hit(const Scene& scene, const Ray& ray, const PrimHit& found, Hit& x);

/// The nearest surface along the ray, if there is one.
std::optional<Hit> intersect(const Scene& scene, const Ray& ray);

/// Whether anything lies on the ray before t_max.
bool occluded(const Scene& scene, const Ray& ray);

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
Rgb sky_towards(const Scene& scene, Vec3 wi);

/// The normal of the mesh at x, smoothed, on the side of x.ng; x.ng if it has none.
Vec3 mesh_normal(const Scene& scene, const Hit& x);

/// The same for any surface. That is x.n but where x.n would look away from the ray that found x:
/// there finish_hit() has put x.ng in its place.
inline Vec3 smooth_normal(const Scene& scene, const Hit& x) {
    bool may_differ = scene.moves || !scene.geometry.normals.empty();
    return may_differ && x.n == x.ng ? mesh_normal(scene, x) : x.n;
}

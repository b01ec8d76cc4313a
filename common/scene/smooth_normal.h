// The smoothed normal of a mesh, for those who see a point from another side than its ray.
#pragma once
#include "common/scene/intersect.h"

/// The normal of the mesh at p, a point of primitive number `prim` at this time: that of the
/// triangle's corners, each by its weight, of any length. 0 where there is none.
Vec3 interpolated_normal(const Scene& scene, uint32_t prim, Vec3 p, float time);

/// The normal of the mesh at x, smoothed, on the side of x.ng. x.n is the same but where it would
/// look away from the ray that found x: there finish_hit() has put x.ng in its place.
inline Vec3 smooth_normal(const Scene& scene, const Hit& x) {
    if (!scene.has_normals || !(x.n == x.ng)) return x.n;
    Vec3 n = interpolated_normal(scene, x.prim, x.p, x.time);
    if (!(dot(n, n) > 0)) return x.ng;
    n = normalize(n);
    return dot(n, x.ng) < 0 ? -n : n;
}

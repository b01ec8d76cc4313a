// The smoothed normal of a mesh, for those who see a point from another side than its ray.
#pragma once
#include "common/scene/intersect.h"

/// The normal of the mesh at x, smoothed, on the side of x.ng. x.n is the same but where it would
/// look away from the ray that found x: there make_hit() has put x.ng in its place.
inline Vec3 smooth_normal(const Scene& scene, const Hit& x) {
    const Geometry& g = scene.geometry;
    bool replaced = x.n == x.ng && !g.normals.empty() && x.prim < g.triangles.size();
    if (!replaced) return x.n;
    const auto& v = g.triangles[x.prim].v;
    Vec3 p0 = g.positions[v[0]], e1 = g.positions[v[1]] - p0, e2 = g.positions[v[2]] - p0;
    Vec3 area = cross(e1, e2);
    float b1 = dot(cross(x.p - p0, e2), area) / dot(area, area);
    float b2 = dot(cross(e1, x.p - p0), area) / dot(area, area);
    Vec3 n = (1 - b1 - b2) * g.normals[v[0]] + b1 * g.normals[v[1]] + b2 * g.normals[v[2]];
    if (!(dot(n, n) > 0)) return x.ng;
    n = normalize(n);
    return dot(n, x.ng) < 0 ? -n : n;
}

// The smoothed normal of a mesh, for those who see a point from another side than its ray.
#pragma once
#include "common/scene/intersect.h"

/// The normal of the mesh at p, a point of triangle number `prim`: that of its corners, each by its
/// weight, of any length. 0 where there is none.
inline Vec3 interpolated_normal(const Geometry& g, uint32_t prim, Vec3 p) {
    if (g.normals.empty() || prim >= g.triangles.size()) return {};
    const auto& v = g.triangles[prim].v;
    Vec3 p0 = g.positions[v[0]], e1 = g.positions[v[1]] - p0, e2 = g.positions[v[2]] - p0;
    Vec3 area = cross(e1, e2);
    float b1 = dot(cross(p - p0, e2), area) / dot(area, area);
    float b2 = dot(cross(e1, p - p0), area) / dot(area, area);
    return (1 - b1 - b2) * g.normals[v[0]] + b1 * g.normals[v[1]] + b2 * g.normals[v[2]];
}

/// The normal of the mesh at x, smoothed, on the side of x.ng. x.n is the same but where it would
/// look away from the ray that found x: there finish_hit() has put x.ng in its place.
inline Vec3 smooth_normal(const Scene& scene, const Hit& x) {
    const Geometry& g = scene.geometry;
    bool replaced = x.n == x.ng && !g.normals.empty() && x.prim < g.triangles.size();
    bool moves = x.n == x.ng && !scene.movers.empty() && x.prim >= g.size();
    if (!replaced && !moves) return x.n;
    Vec3 n = replaced ? interpolated_normal(g, x.prim, x.p)
                      : normal_of_mover(scene, x.prim, x.p, x.time);
    if (!(dot(n, n) > 0)) return x.ng;
    n = normalize(n);
    return dot(n, x.ng) < 0 ? -n : n;
}

// The hierarchy of bounding boxes that finds what a ray hits (chapter 05).
#pragma once
#include <cstdint>

#include "common/geometry.h"

/// The nearest primitive a ray meets. b1, b2: weights of a triangle's second and third vertex.
struct PrimHit {
    static constexpr uint32_t none = ~0u;
    uint32_t prim = none;
    float t = infinity, b1 = 0, b2 = 0;
};

struct Bvh {};  // stand-in until chapter 05 is written

/// Tests every primitive in turn: the slow and certain way, which every hierarchy must agree with.
/// Of two hits at the same t the lower number wins.
inline PrimHit linear_scan(const Geometry& g, Ray ray) {
    PrimHit best;
    Shear shear = shear_to_ray(ray.d);
    uint32_t prim = 0;
    for (const Triangle& tri : g.triangles) {
        if (auto hit = intersect_triangle(ray, shear, g.positions[tri.v[0]], g.positions[tri.v[1]],
                                          g.positions[tri.v[2]])) {
            best = {prim, hit->t, hit->b1, hit->b2};
            ray.t_max = hit->t;
        }
        prim++;
    }
    for (const Sphere& s : g.spheres) {
        if (auto t = intersect_sphere(ray, s.c, s.r)) best = {prim, ray.t_max = *t};
        prim++;
    }
    for (const Disk& disk : g.disks) {
        if (auto t = intersect_disk(ray, disk.c, disk.n, disk.r)) best = {prim, ray.t_max = *t};
        prim++;
    }
    return best;
}

inline Bvh build_bvh(const Geometry&, int /*threads*/) { return {}; }
inline PrimHit closest_hit(const Bvh&, const Geometry& g, const Ray& ray) {
    return linear_scan(g, ray);
}
inline bool any_hit(const Bvh&, const Geometry& g, const Ray& ray) {
    return linear_scan(g, ray).prim != PrimHit::none;
}

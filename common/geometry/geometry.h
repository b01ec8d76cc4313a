// Rays, and the primitives that a scene is made of.
#pragma once
#include <cstdint>
#include <vector>

#include "common/base/vec.h"

/// The points o + t d with 0 < t < t_max. d need not be a unit vector: t counts lengths of d.
struct Ray {
    Vec3 o;
    Vec3 d;
    float t_max = infinity;
    float time = 0;       // of shapes that move
    uint32_t from = ~0u;  // number of the triangle that it leaves, and need not be tested against
};

// `shape` is the index into Scene::shapes of the directive that made the primitive.
struct Triangle {
    uint32_t v[3];  // into Geometry::positions, counter-clockwise seen from the side of its normal
    uint32_t shape;
};
struct Sphere {
    Vec3 c;
    float r;
    uint32_t shape;
};
struct Disk {
    Vec3 c, n;  // n: unit
    float r;
    uint32_t shape;
};

/// All primitives of a scene in world space, numbered through: triangles, then spheres, then disks.
struct Geometry {
    std::vector<Vec3> positions;
    std::vector<Vec3> normals;  // of the vertices; empty, or one for each position (0: flat there)
    std::vector<Vec2> uvs;      // of the vertices, for textures; the same (NaN: none there)
    std::vector<Triangle> triangles;
    std::vector<Vec3> facet_normals;  // unit, of the triangles; prepare() works them out
    std::vector<Sphere> spheres;
    std::vector<Disk> disks;

    uint32_t size() const {
        return static_cast<uint32_t>(triangles.size() + spheres.size() + disks.size());
    }
};

/// A box with sides along the axes; empty until something is added.
struct Box {
    Vec3 low = {infinity, infinity, infinity}, high = {-infinity, -infinity, -infinity};

    void add(Vec3 p) { add(Box{p, p}); }
    void add(const Box& b) {
        low = min(low, b.low);
        high = max(high, b.high);
    }
    Vec3 centre() const { return 0.5f * low + 0.5f * high; }
    /// m^2, of all six sides.
    float area() const {
        Vec3 d = high - low;
        return d.x < 0 ? 0 : 2 * (d.x * d.y + d.y * d.z + d.z * d.x);
    }
};

/// Calls the one of the three functions that fits primitive number `prim`, with that primitive;
/// they return the same type.
template <class OnTriangle, class OnSphere, class OnDisk>
auto visit(const Geometry& g, uint32_t prim, const OnTriangle& on_triangle,
           const OnSphere& on_sphere, const OnDisk& on_disk) {
    size_t i = prim;
    if (i < g.triangles.size()) return on_triangle(g.triangles[i]);
    i -= g.triangles.size();
    if (i < g.spheres.size()) return on_sphere(g.spheres[i]);
    return on_disk(g.disks[i - g.spheres.size()]);
}

/// The box around a ball of radius r around c.
inline Box box_of_ball(Vec3 c, float r) { return {c - Vec3{r, r, r}, c + Vec3{r, r, r}}; }

/// The box around one primitive, relative to `origin`; of a disk, with all of the sphere around it.
inline Box box_of(const Geometry& g, uint32_t prim, Vec3 origin = {}) {
    auto of_ball = [&](const auto& round) { return box_of_ball(round.c - origin, round.r); };
    auto of_triangle = [&](const Triangle& triangle) {
        Box box;
        for (uint32_t v : triangle.v) box.add(g.positions[v] - origin);
        return box;
    };
    return visit(g, prim, of_triangle, of_ball, of_ball);
}

/// The box around all vertices, spheres and disks.
inline Box bounds_of(const Geometry& g) {
    Box box;
    for (Vec3 p : g.positions) box.add(p);
    for (const Sphere& s : g.spheres) box.add(box_of_ball(s.c, s.r));
    for (const Disk& d : g.disks) box.add(box_of_ball(d.c, d.r));
    return box;
}

/// The nearest primitive a ray meets. b1, b2: weights of a triangle's second and third vertex.
struct PrimHit {
    static constexpr uint32_t none = ~0u;
    uint32_t prim = none;
    float t = infinity, b1 = 0, b2 = 0;
};

/// How far off a point computed from numbers of this size may lie: some units in the last place.
inline float rounding_error(float size) { return size * 8 * 0x1p-24f; }

/// How far a shadow ray goes from a point to a lamp, a ball of this radius around p (0: a point or
/// a flat lamp) at this distance: so short of it that the ray does not meet the lamp itself.
///
/// The points at both ends are off by up to eps and by the rounding of p; a lamp that is seen at an
/// angle, with this cosine, is nearer along the ray by 1 / cos of that.
inline float just_short_of(Vec3 p, float radius, float dist, float cos, float eps) {
    eps += rounding_error(max_component(abs(p)) + radius);
    return dist - radius - 2 * eps / cos;
}

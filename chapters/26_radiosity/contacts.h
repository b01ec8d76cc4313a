// Triangles cut where others stand on them or pass through them.
#pragma once
#include <array>

#include "common/base/parallel.h"
#include "common/geometry/box_tree.h"
#include "common/scene/scene.h"

namespace ch26 {

using Polygon = std::vector<Vec3>;  // convex; its corners, counter-clockwise

/// The corners of triangle number `prim`.
inline std::array<Vec3, 3> corners(const Scene& scene, uint32_t prim) {
    const Geometry& g = scene.geometry;
    const Triangle& t = g.triangles[prim];
    return {g.positions[t.v[0]], g.positions[t.v[1]], g.positions[t.v[2]]};
}

/// Cuts the polygon by a plane through o: its part on the side to which m points.
inline Polygon clip(const Polygon& polygon, Vec3 o, Vec3 m) {
    Polygon kept;
    for (size_t i = 0; i < polygon.size(); i++) {
        Vec3 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
        float da = dot(a - o, m), db = dot(b - o, m);
        if (da >= 0) kept.push_back(a);
        if ((da > 0 && db < 0) || (da < 0 && db > 0)) kept.push_back(a + da / (da - db) * (b - a));
    }
    return kept;
}

/// The line along which triangle s touches or crosses the plane through o with normal n: two
/// points. Three when it lies in the plane, where it hides nothing; else fewer.
inline Polygon contact(const std::array<Vec3, 3>& s, Vec3 o, Vec3 n, float eps) {
    Polygon points;
    float d[3];
    for (size_t i = 0; i < 3; i++) {
        d[i] = dot(s[i] - o, n);
        if (std::abs(d[i]) <= eps) d[i] = 0, points.push_back(s[i]);
    }
    for (size_t i = 0; i < 3; i++) {
        size_t j = (i + 1) % 3;
        if (d[i] * d[j] < 0) points.push_back(s[i] + d[i] / (d[i] - d[j]) * (s[j] - s[i]));
    }
    return points;
}

/// Cuts those pieces of a triangle with normal n that the line from a to b crosses.
inline void cut(std::vector<Polygon>& pieces, Vec3 a, Vec3 b, Vec3 n, float eps) {
    if (length(b - a) <= eps) return;
    Vec3 along = normalize(b - a), across = cross(n, along);
    std::vector<Polygon> result;
    for (const Polygon& piece : pieces) {
        float low = 0, high = 0;  // how far the piece reaches to both sides of the line
        for (Vec3 p : piece) {
            low = std::min(low, dot(p - a, across));
            high = std::max(high, dot(p - a, across));
        }
        Polygon left = clip(piece, a, across), right = clip(piece, a, -across);
        float first = infinity, last = -infinity;  // of the line, within the piece
        for (Vec3 p : left) {
            if (std::abs(dot(p - a, across)) > eps) continue;
            first = std::min(first, dot(p - a, along)), last = std::max(last, dot(p - a, along));
        }
        float inside = std::min(last, length(b - a)) - std::max(first, 0.0f);
        if (low < -eps && high > eps && inside > eps) {
            result.push_back(left), result.push_back(right);
        } else {
            result.push_back(piece);
        }
    }
    pieces = result;
}

/// The pieces of each triangle, cut where others stand on it or pass through it: no patch then has
/// light on one side of a wall and dark on the other.
///
/// n log n for n triangles of which each is near few others. Those that it does not come to before
/// `stopped()` stay whole. Spheres and disks hide nothing here (see tessellate.h).
/// tested by  "failure: no light under a wall: patches are cut where it stands"
inline std::vector<std::vector<Polygon>> cut_at_contacts(const Scene& scene, int threads,
                                                         const Stopped& stopped = {}) {
    size_t n = scene.geometry.triangles.size();
    float eps = 1e-5f * scene.radius;
    std::vector<Box> boxes;
    for (uint32_t prim = 0; prim < n; prim++) {
        auto [a, b, c] = corners(scene, prim);
        boxes.push_back({min(min(a, b), c), max(max(a, b), c)});
    }
    BoxTree tree(boxes);
    std::vector<std::vector<Polygon>> pieces(n);
    parallel_for(static_cast<int>(n), threads, [&](int index) {
        uint32_t prim = static_cast<uint32_t>(index);
        auto t = corners(scene, prim);
        Vec3 normal = scene.geometry.facet_normals[prim];
        pieces[prim] = {{t[0], t[1], t[2]}};
        if (stopped && stopped()) return;
        for (uint32_t other : tree.near(boxes[prim], eps)) {
            if (other == prim) continue;
            Polygon points = contact(corners(scene, other), t[0], normal, eps);
            if (points.size() == 2) cut(pieces[prim], points[0], points[1], normal, eps);
        }
    });
    return pieces;
}

}  // namespace ch26

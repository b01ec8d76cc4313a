// Chapter 20: triangles cut where others stand on them or pass through them.
#pragma once
#include <array>

#include "common/scene/intersect.h"

namespace ch20 {

inline std::array<Vec3, 3> corners(const Scene& scene, uint32_t prim) {
    const Geometry& g = scene.geometry;
    const Triangle& t = g.triangles[prim];
    return {g.positions[t.v[0]], g.positions[t.v[1]], g.positions[t.v[2]]};
}

using Polygon = std::vector<Vec3>;  // convex

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

/// The pieces of a triangle, cut where others stand on it or pass through it: no patch then has
/// light on one side of a wall and dark on the other.
inline std::vector<Polygon> cut_at_contacts(const Scene& scene, uint32_t prim) {
    auto t = corners(scene, prim);
    Vec3 n = scene.geometry.facet_normals[prim];
    float eps = 1e-5f * scene.radius;
    Vec3 low = min(min(t[0], t[1]), t[2]), high = max(max(t[0], t[1]), t[2]);
    std::vector<Polygon> pieces = {{t[0], t[1], t[2]}};
    for (uint32_t other = 0; other < scene.geometry.triangles.size(); other++) {
        auto s = corners(scene, other);
        Vec3 gap = max(min(min(s[0], s[1]), s[2]) - high, low - max(max(s[0], s[1]), s[2]));
        if (other == prim || max_component(gap) > eps) continue;
        Polygon points = contact(s, t[0], n, eps);
        if (points.size() == 2) cut(pieces, points[0], points[1], n, eps);
    }
    return pieces;
}

}  // namespace ch20

// Meshes for the tests of the hierarchy.
#pragma once
#include <cmath>
#include <map>

#include "common/geometry/geometry.h"
#include "common/path/sampler.h"

/// Whether two hits are the same, as far as float tells: the hierarchy works out most distances in
/// float, the linear scan all of them in double precision (what is right: intersect.cpp). Where
/// two primitives meet, either may be the one.
inline bool same_hit(const PrimHit& a, const PrimHit& b) {
    if (a.prim == PrimHit::none || b.prim == PrimHit::none) return a.prim == b.prim;
    return std::abs(a.t / b.t - 1) <= 0x1p-12f;
}

/// A surface of nu x nv rectangles, each cut in two: point(a, b) for a, b in [0,1].
template <typename Point>
void add_surface(Geometry& g, uint32_t nu, uint32_t nv, const Point& point) {
    uint32_t base = static_cast<uint32_t>(g.positions.size());
    g.positions.reserve(base + size_t{nu + 1} * (nv + 1));
    g.triangles.reserve(g.triangles.size() + size_t{2} * nu * nv);
    for (uint32_t j = 0; j <= nv; j++) {
        float b = static_cast<float>(j) / static_cast<float>(nv);
        for (uint32_t i = 0; i <= nu; i++) {
            g.positions.push_back(point(static_cast<float>(i) / static_cast<float>(nu), b));
        }
    }
    for (uint32_t j = 0; j < nv; j++) {
        for (uint32_t i = 0; i < nu; i++) {
            uint32_t p = base + j * (nu + 1) + i, above = p + nu + 1;
            g.triangles.push_back({{p, p + 1, above + 1}, 0});
            g.triangles.push_back({{p, above + 1, above}, 0});
        }
    }
}

/// n x n squares, from corner o along the sides u and v.
inline void add_parallelogram(Geometry& g, Vec3 o, Vec3 u, Vec3 v, uint32_t n = 1) {
    add_surface(g, n, n, [&](float a, float b) { return o + a * u + b * v; });
}

inline void add_box(Geometry& g, Vec3 low, Vec3 high) {
    Vec3 d = high - low, x = {d.x, 0, 0}, y = {0, d.y, 0}, z = {0, 0, d.z};
    for (Vec3 side : {Vec3{}, z}) add_parallelogram(g, low + side, x, y);
    for (Vec3 side : {Vec3{}, y}) add_parallelogram(g, low + side, x, z);
    for (Vec3 side : {Vec3{}, x}) add_parallelogram(g, low + side, y, z);
}

/// A ball with bumps of all sizes, of n^2 triangles.
inline void add_bumpy_ball(Geometry& g, Vec3 centre, float r, uint32_t n) {
    add_surface(g, n, n / 2, [&](float a, float b) {
        float phi = 2 * pi * a, theta = pi * b, bumps = 1;
        Vec3 d = {std::sin(theta) * std::cos(phi), std::cos(theta),
                  std::sin(theta) * std::sin(phi)};
        float waves = 3, height = 0.25f, shift = 0;
        for (int octave = 0; octave < 5; octave++) {
            bumps += height * std::sin(waves * d.x + shift) * std::sin(waves * d.y + 0.7f) *
                     std::sin(waves * d.z + 2.1f);
            waves *= 2, height /= 2, shift += 1.3f;
        }
        return centre + r * bumps * d;
    });
}

/// Long thin triangles across all axes in the unit cube: boxes that hold next to nothing.
inline Geometry thin_diagonals(uint32_t n) {
    Geometry g;
    Sampler random(SamplerType::independent, 7, 1);
    for (uint32_t i = 0; i < n; i++) {
        random.start(i, 0);
        Vec2 a = random.u2(), b = random.u2(), c = random.u2(), e = random.u2();
        Vec3 centre = {a.x, a.y, b.x}, along = normalize({1, 1 - 0.5f * b.y, 1 - 0.5f * c.x});
        Vec3 across = {c.y - 0.5f, e.x - 0.5f, e.y - 0.5f};
        Vec3 from = centre - 0.3f * along, to = centre + 0.3f * along;
        g.positions.insert(g.positions.end(), {from, to, to + 0.02f * across});
        g.triangles.push_back({{3 * i, 3 * i + 1, 3 * i + 2}, 0});
    }
    return g;
}

/// A closed mesh around the origin: an octahedron whose edges are cut in two, again and again, at
/// points that are moved in or out.
inline Geometry closed_mesh(int cuts) {
    Geometry g;
    Sampler random(SamplerType::independent, 3, 1);
    random.start(0, 0);
    g.positions = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    for (uint32_t x : {0u, 1u})
        for (uint32_t y : {2u, 3u})
            for (uint32_t z : {4u, 5u}) g.triangles.push_back({{x, y, z}, 0});
    for (int cut = 0; cut < cuts; cut++) {
        std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
        auto middle = [&](uint32_t a, uint32_t b) {
            auto [found, added] =
                middles.try_emplace(std::minmax(a, b), static_cast<uint32_t>(g.positions.size()));
            if (added)
                g.positions.push_back((0.8f + 0.4f * random.u1()) *
                                      normalize(g.positions[a] + g.positions[b]));
            return found->second;
        };
        std::vector<Triangle> finer;
        for (const Triangle& t : g.triangles) {
            auto [a, b, c] = t.v;
            uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            for (Triangle part : {Triangle{{a, ab, ca}, 0},
                                  {{ab, b, bc}, 0},
                                  {{ca, bc, c}, 0},
                                  {{ab, bc, ca}, 0}}) {
                finer.push_back(part);
            }
        }
        g.triangles = finer;
    }
    return g;
}

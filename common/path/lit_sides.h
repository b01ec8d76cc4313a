// Which sides of the triangles of a diffuse scene light can reach (chapter 26).
#pragma once
#include "common/base/parallel.h"
#include "common/geometry/triangle_grid.h"
#include "common/material/cosine.h"
#include "common/path/sampler.h"
#include "common/scene/intersect.h"

inline constexpr uint32_t no_side = ~0u;

/// The corners of triangle number `prim`.
inline Corners corners(const Scene& scene, uint32_t prim) {
    const Geometry& g = scene.geometry;
    const Triangle& t = g.triangles[prim];
    return {g.positions[t.v[0]], g.positions[t.v[1]], g.positions[t.v[2]]};
}

/// What a side of triangle number `prim` emits, W m^-2, and reflects.
inline Rgb emitted(const Scene& scene, uint32_t prim, bool front) {
    const Shape& shape = scene.shapes[scene.geometry.triangles[prim].shape];
    if (shape.light < 0) return {};
    const Light& light = scene.lights[static_cast<size_t>(shape.light)];
    return front || light.two_sided ? pi * light.L : Rgb{};
}
inline Rgb reflectance(const Scene& scene, uint32_t prim) {
    return scene.materials[scene.shapes[scene.geometry.triangles[prim].shape].material].reflectance;
}

/// The sides that rays from this side meet: 2 i is the front of triangle i, 2 i + 1 its back;
/// no_side when one meets nothing.
inline std::vector<uint32_t> sides_seen(const Scene& scene, uint32_t side) {
    constexpr uint32_t rays = 256;
    auto [a, b, c] = corners(scene, side / 2);
    Vec3 n = scene.geometry.facet_normals[side / 2];
    if (side % 2 == 1) n = -n;
    Frame frame(n);
    Sampler sampler(SamplerType::sobol, 0, rays);
    std::vector<uint32_t> seen;
    for (uint32_t i = 0; i < rays; i++) {
        sampler.start(side, i);
        Vec2 u = sampler.u2();
        float s = std::sqrt(u.x);
        Vec3 x = (1 - s) * a + s * (1 - u.y) * b + s * u.y * c;
        x += rounding_error(max_component(abs(x))) * n;
        auto y = intersect(scene, {x, frame.to_world(sample_cosine_hemisphere(sampler.u2()))});
        seen.push_back(y ? 2 * y->prim + (y->front ? 0 : 1) : no_side);
    }
    std::sort(seen.begin(), seen.end());
    seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
    return seen;
}

/// Which sides light can reach: spreads from the lamps to what they see, and on from all that
/// reflects. Finds also whether the room is closed.
inline std::vector<char> find_lit_sides(const Scene& scene, bool& closed, int threads) {
    size_t count = 2 * scene.geometry.triangles.size();
    std::vector<std::vector<uint32_t>> seen(count);
    parallel_for(static_cast<int>(count), threads, [&](int side) {
        seen[static_cast<size_t>(side)] = sides_seen(scene, static_cast<uint32_t>(side));
    });
    std::vector<char> lit(count), sends(count);  // sends: what reaches it goes on from there
    for (uint32_t side = 0; side < count; side++) {
        lit[side] = !is_black(emitted(scene, side / 2, side % 2 == 0));
        sends[side] = lit[side] || !is_black(reflectance(scene, side / 2));
    }
    closed = true;
    for (bool changed = true; changed;) {
        changed = false;
        auto reach = [&](size_t from, size_t to) {
            if (!lit[from] || !sends[from] || lit[to]) return;
            lit[to] = changed = true;
        };
        for (size_t a = 0; a < count; a++) {
            for (uint32_t b : seen[a]) {
                if (b == no_side) {
                    if (lit[a] && sends[a]) closed = false;
                } else {
                    reach(a, b);
                    reach(b, a);  // rays from b may miss a small side
                }
            }
        }
    }
    return lit;
}

// The patches of radiosity: small triangles, each with one radiosity.
#pragma once
#include "common/base/parallel.h"
#include "common/path/radiosity.h"
#include "common/path/sampler.h"
#include "common/scene/intersect.h"

namespace ch26 {

/// One side of a small triangle.
struct Patch {
    Corners p;  // corners, counter-clockwise seen from this side
    Vec3 n, centre;
    float area = 0;  // m^2
    float eps = 0;   // m: how far points may be off the surface
    Rgb E, rho;      // W m^-2 that it emits; the share that it reflects
};

/// How a triangle of the scene is divided: into k x k patches on each side that has light.
struct Division {
    Corners p;  // the triangle's corners
    uint32_t k = 0;
    std::array<uint32_t, 2> first = {no_side, no_side};  // front, back: the first patch
};

/// All patches, and where those of each triangle are.
struct Patches {
    std::vector<Patch> patch;
    std::vector<Division> division;
    bool closed = false;  // no light gets out of the room
};

/// The patch of one small triangle, whose corners are those of the front.
inline Patch make_patch(const Scene& scene, uint32_t prim, bool front, const Corners& t) {
    Patch patch;
    patch.p = front ? t : Corners{t[0], t[2], t[1]};
    patch.E = emitted(scene, prim, front), patch.rho = reflectance(scene, prim);
    Vec3 sides = cross(patch.p[1] - t[0], patch.p[2] - t[0]);
    patch.n = normalize(sides), patch.area = length(sides) / 2;
    patch.centre = (t[0] + t[1] + t[2]) / 3;
    patch.eps = rounding_error(max_component(max(max(abs(t[0]), abs(t[1])), abs(t[2]))));
    return patch;
}

/// Chooses k of each triangle: no edge of a patch is longer than h. Returns how many patches that
/// makes on the sides that have light.
inline size_t choose_k(const std::vector<char>& lit, float h, std::vector<Division>& division) {
    size_t count = 0;
    for (size_t i = 0; i < division.size(); i++) {
        float longest = std::sqrt(longest_edge2(division[i].p));
        uint32_t k = static_cast<uint32_t>(std::ceil(std::clamp(longest / h, 1.0f, 4096.0f)));
        division[i].k = k;
        for (size_t side : {2 * i, 2 * i + 1})
            if (lit[side]) count += size_t{k} * k;
    }
    return count;
}

/// At least `wanted` patches, all about alike in size, where light can reach.
/// The scene consists of triangles alone (see refuse()).
/// tested by  "identity: patches cover what has light, and each point finds its patch"
inline Patches make_patches(const Scene& scene, size_t wanted, int threads) {
    Patches patches;
    for (uint32_t i = 0; i < scene.geometry.triangles.size(); i++)
        patches.division.push_back({corners(scene, i)});
    std::vector<char> lit = find_lit_sides(scene, patches.closed, threads);

    // Choose the size, then divide the sides that have light.
    float h = 2 * scene.radius;
    size_t count = choose_k(lit, h, patches.division);
    while (count < wanted && count > 0) count = choose_k(lit, h *= 0.97f, patches.division);
    for (uint32_t i = 0; i < patches.division.size(); i++) {
        Division& d = patches.division[i];
        for (size_t back : {size_t{0}, size_t{1}}) {
            if (!lit[2 * i + back]) continue;
            d.first[back] = static_cast<uint32_t>(patches.patch.size());
            for_each_in_grid(d.p, d.k, [&](const Corners& t) {
                patches.patch.push_back(make_patch(scene, i, back == 0, t));
            });
        }
    }
    return patches;
}

/// Where a point lies: the number of its patch (no_side: on a side without light), and its weights
/// there.
inline PlaceInGrid place_of(const Patches& patches, const Hit& x) {
    size_t back = x.front ? 0 : 1;
    const Division& d = patches.division[x.prim];
    if (d.first[back] == no_side) return {};

    auto [number, b] = place_in_grid(d.p, d.k, x.p);
    if (back) std::swap(b[1], b[2]);
    return {d.first[back] + number, b};
}

/// A point of each quarter of the patch, chosen by chance, just off the surface.
inline std::array<Vec3, 4> points_on(const Patch& p, uint32_t key) {
    std::array<Vec3, 4> points;
    auto parts = quarters(p.p);
    for (uint32_t i = 0; i < 4; i++) {
        uint32_t bits = hash32(key + i);
        float s = std::sqrt(to_unit_float(bits)), v = to_unit_float(hash32(bits));
        const auto& t = parts[i];
        points[i] = (1 - s) * t[0] + s * (1 - v) * t[1] + s * v * t[2] + p.eps * p.n;
    }
    return points;
}

/// Whether some of q lies before p.
inline bool faces(const Patch& p, const Patch& q) {
    for (Vec3 y : q.p)
        if (dot(y - p.centre, p.n) > 2 * (p.eps + q.eps)) return true;
    return false;
}

/// Whether nothing is between x and y.
inline bool sees(const Scene& scene, Vec3 x, Vec3 y) { return !occluded(scene, {x, y - x, 1}); }

}  // namespace ch26

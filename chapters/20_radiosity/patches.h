// Chapter 20, the patches: small triangles, each with one radiosity.
#pragma once
#include <array>

#include "common/base/parallel.h"
#include "common/material/cosine.h"
#include "common/path/sampler.h"
#include "common/scene/intersect.h"

namespace ch20 {

/// One side of a small triangle.
struct Patch {
    std::array<Vec3, 3> p;  // corners, counter-clockwise seen from this side
    Vec3 n, centre;
    float area = 0;  // m^2
    float eps = 0;   // m: how far points may be off the surface
    Rgb E, rho;      // W m^-2 that it emits; the share that it reflects
};

/// A triangle of the scene, or a part of one, cut into k x k patches for each side that has light.
struct Piece {
    std::array<Vec3, 3> p;
    uint32_t k = 0;
    std::array<uint32_t, 2> first = {none, none};  // front, back: the first patch
    static constexpr uint32_t none = ~0u;
};

/// All patches, and where those of a triangle are.
struct Patches {
    std::vector<Patch> patch;
    std::vector<Piece> pieces;
    std::vector<uint32_t> first_piece;  // of each triangle, and one more
    bool closed = false;                // no light gets out of the room
};

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
inline std::array<Vec3, 3> corners(const Scene& scene, uint32_t prim) {
    const Geometry& g = scene.geometry;
    const Triangle& t = g.triangles[prim];
    return {g.positions[t.v[0]], g.positions[t.v[1]], g.positions[t.v[2]]};
}

/// Which sides light can reach: 2 prim for the front of a triangle, 2 prim + 1 for its back.
struct Sides {
    std::vector<char> lit;
    bool closed = true;
};

/// The sides that rays from this side meet; Piece::none when one meets nothing.
inline std::vector<uint32_t> sides_seen(const Scene& scene, uint32_t side) {
    constexpr uint32_t rays = 256;
    auto p = corners(scene, side / 2);
    Vec3 n = scene.geometry.facet_normals[side / 2];
    if (side % 2 == 1) n = -n;
    Frame frame(n);
    Sampler sampler(SamplerType::sobol, 0, rays);
    std::vector<uint32_t> seen;
    for (uint32_t i = 0; i < rays; i++) {
        sampler.start(side, i);
        Vec2 u = sampler.u2();
        float s = std::sqrt(u.x);
        Vec3 x = (1 - s) * p[0] + s * (1 - u.y) * p[1] + s * u.y * p[2];
        x += rounding_error(max_component(abs(x))) * n;
        auto y = intersect(scene, {x, frame.to_world(sample_cosine_hemisphere(sampler.u2()))});
        seen.push_back(y ? 2 * y->prim + (y->front ? 0 : 1) : Piece::none);
    }
    std::sort(seen.begin(), seen.end());
    seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
    return seen;
}

/// Spreads from the lamps to what they see, and on from all that reflects.
inline Sides find_lit_sides(const Scene& scene, int threads) {
    size_t count = 2 * scene.geometry.triangles.size();
    std::vector<std::vector<uint32_t>> seen(count), also(count);
    parallel_for(static_cast<int>(count), threads, [&](int side) {
        seen[static_cast<size_t>(side)] = sides_seen(scene, static_cast<uint32_t>(side));
    });
    for (size_t a = 0; a < count; a++) {
        for (uint32_t b : seen[a])
            if (b != Piece::none) also[b].push_back(static_cast<uint32_t>(a));
    }
    Sides sides{std::vector<char>(count)};
    std::vector<uint32_t> next;
    auto reach = [&](uint32_t side) {
        if (side == Piece::none) sides.closed = false;
        if (side == Piece::none || sides.lit[side]) return;
        sides.lit[side] = 1;
        next.push_back(side);
    };
    auto shines = [&](uint32_t side) { return !is_black(emitted(scene, side / 2, side % 2 == 0)); };
    for (uint32_t side = 0; side < count; side++) {
        if (shines(side)) reach(side);
    }
    while (!next.empty()) {
        uint32_t side = next.back();
        next.pop_back();
        if (!shines(side) && is_black(reflectance(scene, side / 2))) continue;
        for (uint32_t other : seen[side]) reach(other);
        for (uint32_t other : also[side]) reach(other);
    }
    return sides;
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
/// points; or its three corners, when it lies in it; else fewer.
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
        for (size_t i = 0; i + 1 < points.size(); i++) {
            cut(pieces, points[i], points[i + 1], n, eps);
        }
        if (points.size() == 3) cut(pieces, points[2], points[0], n, eps);
    }
    return pieces;
}

/// The k x k patches of one side of a piece, row by row.
inline void add_patches(const Piece& piece, Patch patch, bool front, std::vector<Patch>& patches) {
    float k = static_cast<float>(piece.k);
    auto at = [&](uint32_t i, uint32_t j) {
        return piece.p[0] + static_cast<float>(i) / k * (piece.p[1] - piece.p[0]) +
               static_cast<float>(j) / k * (piece.p[2] - piece.p[0]);
    };
    auto add = [&](Vec3 a, Vec3 b, Vec3 c) {
        patch.p = front ? std::array{a, b, c} : std::array{a, c, b};
        Vec3 sides = cross(patch.p[1] - a, patch.p[2] - a);
        patch.n = normalize(sides), patch.area = length(sides) / 2;
        patch.centre = (a + b + c) / 3;
        patch.eps = rounding_error(max_component(max(max(abs(a), abs(b)), abs(c))));
        patches.push_back(patch);
    };
    for (uint32_t j = 0; j < piece.k; j++) {
        for (uint32_t i = 0; i + j < piece.k; i++) {
            add(at(i, j), at(i + 1, j), at(i, j + 1));
            if (i + j + 1 < piece.k) add(at(i + 1, j + 1), at(i, j + 1), at(i + 1, j));
        }
    }
}

/// The pieces of the triangles that have light, none with an edge longer than h after division.
inline Patches divide(const Scene& scene, const Sides& sides,
                      const std::vector<std::vector<Polygon>>& pieces, float h) {
    Patches result;
    result.closed = sides.closed;
    for (uint32_t prim = 0; prim < pieces.size(); prim++) {
        result.first_piece.push_back(static_cast<uint32_t>(result.pieces.size()));
        for (const Polygon& polygon : pieces[prim]) {
            for (size_t i = 2; i < polygon.size(); i++) {
                Piece piece{{polygon[0], polygon[i - 1], polygon[i]}};
                float longest = 0;
                for (size_t e = 0; e < 3; e++)
                    longest = std::max(longest, length(piece.p[e] - piece.p[(e + 1) % 3]));
                piece.k = static_cast<uint32_t>(std::ceil(std::clamp(longest / h, 1.0f, 4096.0f)));
                for (size_t back : {size_t{0}, size_t{1}}) {
                    if (!sides.lit[2 * prim + back]) continue;
                    piece.first[back] = static_cast<uint32_t>(result.patch.size());
                    Patch patch;
                    patch.E = emitted(scene, prim, back == 0);
                    patch.rho = reflectance(scene, prim);
                    add_patches(piece, patch, back == 0, result.patch);
                }
                result.pieces.push_back(piece);
            }
        }
    }
    result.first_piece.push_back(static_cast<uint32_t>(result.pieces.size()));
    return result;
}

/// At least `wanted` patches, all about alike in size.
inline Patches make_patches(const Scene& scene, size_t wanted, int threads) {
    Sides sides = find_lit_sides(scene, threads);
    std::vector<std::vector<Polygon>> pieces(scene.geometry.triangles.size());
    parallel_for(static_cast<int>(pieces.size()), threads, [&](int prim) {
        pieces[static_cast<size_t>(prim)] = cut_at_contacts(scene, static_cast<uint32_t>(prim));
    });
    float h = 2 * scene.radius;
    Patches patches = divide(scene, sides, pieces, h);
    while (patches.patch.size() < wanted && !patches.patch.empty()) {
        h *= 0.97f;
        patches = divide(scene, sides, pieces, h);
    }
    return patches;
}

/// Where a point lies: its patch (Piece::none: on a side without light), and its weights there.
struct Place {
    uint32_t patch = Piece::none;
    std::array<float, 3> b = {1, 0, 0};
};

inline Place place_of(const Patches& patches, const Hit& x) {
    // Find the piece that x lies in, or nearest to: where its least weight is largest.
    const Piece* piece = nullptr;
    float best = -infinity, b1 = 0, b2 = 0;
    for (uint32_t i = patches.first_piece[x.prim]; i < patches.first_piece[x.prim + 1]; i++) {
        const Piece& q = patches.pieces[i];
        Vec3 u = q.p[1] - q.p[0], v = q.p[2] - q.p[0], n = cross(u, v), d = x.p - q.p[0];
        float w1 = dot(cross(d, v), n) / dot(n, n), w2 = dot(cross(u, d), n) / dot(n, n);
        float least = std::min({w1, w2, 1 - w1 - w2});
        if (least > best) best = least, b1 = w1, b2 = w2, piece = &q;
    }
    size_t back = x.front ? 0 : 1;
    if (!piece || piece->first[back] == Piece::none) return {};

    // Find the patch in its rows of 2 (k - j) - 1, and the weights of its corners.
    float k = static_cast<float>(piece->k);
    float j = std::clamp(std::floor(k * b2), 0.0f, k - 1);
    float i = std::clamp(std::floor(k * b1), 0.0f, k - 1 - j);
    float u = std::clamp(k * b1 - i, 0.0f, 1.0f), v = std::clamp(k * b2 - j, 0.0f, 1.0f);
    bool upper = u + v > 1 && i + j + 1 < k;
    if (!upper && u + v > 1) u /= u + v, v = 1 - u;
    Place place;
    place.patch = piece->first[back] + static_cast<uint32_t>(2 * k * j - j * j + 2 * i + upper);
    place.b = upper ? std::array{u + v - 1, 1 - u, 1 - v} : std::array{1 - u - v, u, v};
    if (back) std::swap(place.b[1], place.b[2]);
    return place;
}

}  // namespace ch20

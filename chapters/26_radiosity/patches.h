// The patches of radiosity: small triangles, each with one radiosity.
#pragma once
#include "chapters/26_radiosity/contacts.h"
#include "common/material/cosine.h"
#include "common/path/sampler.h"
#include "common/scene/intersect.h"

namespace ch26 {

/// One side of a small triangle.
struct Patch {
    std::array<Vec3, 3> p;  // corners, counter-clockwise seen from this side
    Vec3 n, centre;
    float area = 0;  // m^2
    float eps = 0;   // m: how far points may be off the surface
    Rgb E, rho;      // W m^-2 that it emits; the share that it reflects
};

/// A triangle of the scene, or a part of one, cut into k x k patches on each side that has light.
struct Piece {
    std::array<Vec3, 3> p;
    uint32_t prim = 0;  // into Scene::geometry
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

/// The triangles' pieces; they have no patches yet.
inline Patches make_pieces(const Scene& scene, int threads, const Stopped& stopped) {
    std::vector<std::vector<Polygon>> polygons = cut_at_contacts(scene, threads, stopped);
    Patches result;
    for (uint32_t prim = 0; prim < polygons.size(); prim++) {
        result.first_piece.push_back(static_cast<uint32_t>(result.pieces.size()));
        for (const Polygon& polygon : polygons[prim]) {
            for (size_t i = 2; i < polygon.size(); i++)
                result.pieces.push_back({{polygon[0], polygon[i - 1], polygon[i]}, prim});
        }
    }
    result.first_piece.push_back(static_cast<uint32_t>(result.pieces.size()));
    return result;
}

/// Where a point lies in a piece: the weights of its second and third corner.
struct PiecePlace {
    uint32_t piece = Piece::none;
    float b1 = 0, b2 = 0;
};

/// The piece that x lies in, or nearest to: where its least weight is largest.
inline PiecePlace find_piece(const Patches& patches, const Hit& x) {
    PiecePlace found;
    float best = -infinity;
    for (uint32_t i = patches.first_piece[x.prim]; i < patches.first_piece[x.prim + 1]; i++) {
        const Piece& q = patches.pieces[i];
        Vec3 u = q.p[1] - q.p[0], v = q.p[2] - q.p[0], n = cross(u, v), d = x.p - q.p[0];
        float b1 = dot(cross(d, v), n) / dot(n, n), b2 = dot(cross(u, d), n) / dot(n, n);
        float least = std::min({b1, b2, 1 - b1 - b2});
        if (least > best) best = least, found = {i, b1, b2};
    }
    return found;
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

/// The sides that rays from this side meet, 2 i for the front of piece i, 2 i + 1 for its back;
/// Piece::none when one meets nothing.
inline std::vector<uint32_t> sides_seen(const Scene& scene, const Patches& pieces, uint32_t side) {
    constexpr uint32_t rays = 256;
    const Piece& piece = pieces.pieces[side / 2];
    Vec3 n = scene.geometry.facet_normals[piece.prim];
    if (side % 2 == 1) n = -n;
    Frame frame(n);
    Sampler sampler(SamplerType::sobol, 0, rays);
    std::vector<uint32_t> seen;
    for (uint32_t i = 0; i < rays; i++) {
        sampler.start(side, i);
        Vec2 u = sampler.u2();
        float s = std::sqrt(u.x);
        Vec3 x = (1 - s) * piece.p[0] + s * (1 - u.y) * piece.p[1] + s * u.y * piece.p[2];
        x += rounding_error(max_component(abs(x))) * n;
        auto y = intersect(scene, {x, frame.to_world(sample_cosine_hemisphere(sampler.u2()))});
        uint32_t other = y ? find_piece(pieces, *y).piece : Piece::none;
        seen.push_back(other == Piece::none ? other : 2 * other + (y->front ? 0 : 1));
    }
    std::sort(seen.begin(), seen.end());
    seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
    return seen;
}

/// Which sides light can reach: spreads from the lamps to what they see, and on from all that
/// reflects. Finds also whether the room is closed.
inline std::vector<char> find_lit_sides(const Scene& scene, Patches& pieces, int threads,
                                        const Stopped& stopped) {
    size_t count = 2 * pieces.pieces.size();
    std::vector<std::vector<uint32_t>> seen(count), also(count);
    parallel_for(static_cast<int>(count), threads, [&](int side) {
        if (stopped && stopped()) return;
        seen[static_cast<size_t>(side)] = sides_seen(scene, pieces, static_cast<uint32_t>(side));
    });
    for (size_t a = 0; a < count; a++) {
        for (uint32_t b : seen[a])
            if (b != Piece::none) also[b].push_back(static_cast<uint32_t>(a));
    }
    std::vector<char> lit(count);
    pieces.closed = true;
    std::vector<uint32_t> next;
    auto reach = [&](uint32_t side) {
        if (side == Piece::none) pieces.closed = false;
        if (side == Piece::none || lit[side]) return;
        lit[side] = 1;
        next.push_back(side);
    };
    auto shines = [&](uint32_t side) {
        return !is_black(emitted(scene, pieces.pieces[side / 2].prim, side % 2 == 0));
    };
    for (uint32_t side = 0; side < count; side++) {
        if (shines(side)) reach(side);
    }
    while (!next.empty()) {
        uint32_t side = next.back();
        next.pop_back();
        bool dark = is_black(reflectance(scene, pieces.pieces[side / 2].prim));
        if (!shines(side) && dark) continue;
        for (uint32_t other : seen[side]) reach(other);
        for (uint32_t other : also[side]) reach(other);
    }
    return lit;
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

/// The square of a triangle's longest edge, m^2.
inline float longest_edge2(const std::array<Vec3, 3>& t) {
    return std::max(
        {length_squared(t[1] - t[0]), length_squared(t[2] - t[1]), length_squared(t[0] - t[2])});
}

/// Chooses k of each piece: no edge of a patch is longer than h. Returns how many patches that
/// makes on the sides that have light.
inline size_t choose_k(const std::vector<char>& lit, float h, std::vector<Piece>& pieces) {
    size_t count = 0;
    for (size_t i = 0; i < pieces.size(); i++) {
        Piece& piece = pieces[i];
        float longest = std::sqrt(longest_edge2(piece.p));
        piece.k = static_cast<uint32_t>(std::ceil(std::clamp(longest / h, 1.0f, 4096.0f)));
        for (size_t side : {2 * i, 2 * i + 1})
            if (lit[side]) count += size_t{piece.k} * piece.k;
    }
    return count;
}

/// Divides the sides that have light.
inline void divide(const Scene& scene, const std::vector<char>& lit, Patches& patches) {
    for (size_t i = 0; i < patches.pieces.size(); i++) {
        Piece& piece = patches.pieces[i];
        for (size_t back : {size_t{0}, size_t{1}}) {
            if (!lit[2 * i + back]) continue;
            piece.first[back] = static_cast<uint32_t>(patches.patch.size());
            Patch patch;
            patch.E = emitted(scene, piece.prim, back == 0);
            patch.rho = reflectance(scene, piece.prim);
            add_patches(piece, patch, back == 0, patches.patch);
        }
    }
}

/// At least `wanted` patches, all about alike in size, where light can reach; a triangle that
/// others touch is cut there. None when `stopped()` before they are made.
/// The scene consists of triangles alone (see tessellate.h).
/// tested by  "identity: patches cover what has light, and each point finds its patch",
///            "input: what makes patches ends when it is asked to"
inline Patches make_patches(const Scene& scene, size_t wanted, int threads,
                            const Stopped& stopped = {}) {
    Patches patches = make_pieces(scene, threads, stopped);
    std::vector<char> lit = find_lit_sides(scene, patches, threads, stopped);
    if (stopped && stopped()) {
        patches.closed = false;  // nobody knows
        return patches;
    }
    float h = 2 * scene.radius;
    size_t count = choose_k(lit, h, patches.pieces);
    while (count < wanted && count > 0) count = choose_k(lit, h *= 0.97f, patches.pieces);
    divide(scene, lit, patches);
    return patches;
}

/// Where a point lies: its patch (Piece::none: on a side without light), and its weights there.
struct Place {
    uint32_t patch = Piece::none;
    std::array<float, 3> b = {1, 0, 0};
};
inline Place place_of(const Patches& patches, const Hit& x) {
    PiecePlace in = find_piece(patches, x);
    size_t back = x.front ? 0 : 1;
    if (in.piece == Piece::none) return {};
    const Piece& piece = patches.pieces[in.piece];
    if (piece.first[back] == Piece::none) return {};

    // Find the patch in its rows of 2 (k - j) - 1, and the weights of its corners.
    float k = static_cast<float>(piece.k);
    float j = std::clamp(std::floor(k * in.b2), 0.0f, k - 1);
    float i = std::clamp(std::floor(k * in.b1), 0.0f, k - 1 - j);
    float u = std::clamp(k * in.b1 - i, 0.0f, 1.0f), v = std::clamp(k * in.b2 - j, 0.0f, 1.0f);
    bool upper = u + v > 1 && i + j + 1 < k;
    if (!upper && u + v > 1) u /= u + v, v = 1 - u;
    uint32_t row = static_cast<uint32_t>(j), column = static_cast<uint32_t>(i);
    Place place;
    place.patch = piece.first[back] + row * (2 * piece.k - row) + 2 * column + upper;
    place.b = upper ? std::array{u + v - 1, 1 - u, 1 - v} : std::array{1 - u - v, u, v};
    if (back) std::swap(place.b[1], place.b[2]);
    return place;
}

/// Parts of a triangle, each half as long as the whole.
inline std::array<std::array<Vec3, 3>, 4> quarters(const std::array<Vec3, 3>& t) {
    Vec3 a = (t[1] + t[2]) / 2, b = (t[2] + t[0]) / 2, c = (t[0] + t[1]) / 2;
    return {{{t[0], c, b}, {c, t[1], a}, {b, a, t[2]}, {a, b, c}}};
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

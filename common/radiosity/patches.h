// The patches of radiosity: small triangles, each with one radiosity.
#pragma once
#include "common/radiosity/contacts.h"
#include "common/scene/intersect.h"

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

/// At least `wanted` patches, all about alike in size, where light can reach; a triangle that
/// others touch is cut there. None when `stopped()` before they are made.
/// The scene consists of triangles alone (see tessellate.h).
/// tested by  "identity: patches cover what has light, and each point finds its patch",
///            "input: what makes patches ends when it is asked to"
Patches make_patches(const Scene& scene, size_t wanted, int threads, const Stopped& stopped = {});

/// Where a point lies: its patch (Piece::none: on a side without light), and its weights there.
struct Place {
    uint32_t patch = Piece::none;
    std::array<float, 3> b = {1, 0, 0};
};
Place place_of(const Patches& patches, const Hit& x);

/// Parts of a triangle, each half as long as the whole.
inline std::array<std::array<Vec3, 3>, 4> quarters(const std::array<Vec3, 3>& t) {
    Vec3 a = (t[1] + t[2]) / 2, b = (t[2] + t[0]) / 2, c = (t[0] + t[1]) / 2;
    return {{{t[0], c, b}, {c, t[1], a}, {b, a, t[2]}, {a, b, c}}};
}

/// The square of a triangle's longest edge, m^2.
inline float longest_edge2(const std::array<Vec3, 3>& t) {
    return std::max(
        {length_squared(t[1] - t[0]), length_squared(t[2] - t[1]), length_squared(t[0] - t[2])});
}

/// A point of each quarter of the patch, chosen by chance, just off the surface.
std::array<Vec3, 4> points_on(const Patch& p, uint32_t key);

/// Whether some of q lies before p.
inline bool faces(const Patch& p, const Patch& q) {
    for (Vec3 y : q.p)
        if (dot(y - p.centre, p.n) > 2 * (p.eps + q.eps)) return true;
    return false;
}

/// Whether nothing is between x and y.
inline bool sees(const Scene& scene, Vec3 x, Vec3 y) { return !occluded(scene, {x, y - x, 1}); }

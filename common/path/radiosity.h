// What radiosity (chapter 26) needs of a scene: diffuse triangles alone, cut into small ones, and
// which of their sides light can reach.
#pragma once
#include <array>

#include "common/scene/scene.h"

/// Throws InputError for all that has no radiosity: paths are LD*E, shapes are triangles, lamps
/// have a surface, and some surface absorbs.
/// tested by  "input: what has no radiosity is refused, with its place in the file"
void refuse(const Scene& scene);

using Corners = std::array<Vec3, 3>;

/// The square of a triangle's longest edge, m^2.
inline float longest_edge2(const Corners& t) {
    return std::max(
        {length_squared(t[1] - t[0]), length_squared(t[2] - t[1]), length_squared(t[0] - t[2])});
}

/// Calls use(corners) for each small triangle, in their order; all turn as the whole one does.
template <class Use>
void for_each_in_grid(const Corners& t, uint32_t k, const Use& use) {
    float cells = static_cast<float>(k);
    auto at = [&](uint32_t i, uint32_t j) {
        return t[0] + static_cast<float>(i) / cells * (t[1] - t[0]) +
               static_cast<float>(j) / cells * (t[2] - t[0]);
    };
    for (uint32_t j = 0; j < k; j++) {
        for (uint32_t i = 0; i + j < k; i++) {
            use(Corners{at(i, j), at(i + 1, j), at(i, j + 1)});
            if (i + j + 1 < k) use(Corners{at(i + 1, j + 1), at(i, j + 1), at(i + 1, j)});
        }
    }
}

inline constexpr uint32_t no_side = ~0u;

/// Where a point of the triangle lies: the number of its small triangle, and its weights there.
struct PlaceInGrid {
    uint32_t number = no_side;
    std::array<float, 3> b = {1, 0, 0};
};
inline PlaceInGrid place_in_grid(const Corners& t, uint32_t cells, Vec3 x) {
    // The weights of the triangle's second and third corner.
    Vec3 e1 = t[1] - t[0], e2 = t[2] - t[0], n = cross(e1, e2), at = x - t[0];
    float b1 = dot(cross(at, e2), n) / dot(n, n), b2 = dot(cross(e1, at), n) / dot(n, n);

    float k = static_cast<float>(cells);
    float j = std::clamp(std::floor(k * b2), 0.0f, k - 1);
    float i = std::clamp(std::floor(k * b1), 0.0f, k - 1 - j);
    float u = std::clamp(k * b1 - i, 0.0f, 1.0f), v = std::clamp(k * b2 - j, 0.0f, 1.0f);
    bool upper = u + v > 1 && i + j + 1 < k;
    if (!upper && u + v > 1) u /= u + v, v = 1 - u;
    uint32_t row = static_cast<uint32_t>(j), column = static_cast<uint32_t>(i);
    return {row * (2 * cells - row) + 2 * column + upper,
            upper ? std::array{u + v - 1, 1 - u, 1 - v} : std::array{1 - u - v, u, v}};
}

/// Parts of a triangle, each half as long as the whole.
inline std::array<Corners, 4> quarters(const Corners& t) {
    Vec3 a = (t[1] + t[2]) / 2, b = (t[2] + t[0]) / 2, c = (t[0] + t[1]) / 2;
    return {{{t[0], c, b}, {c, t[1], a}, {b, a, t[2]}, {a, b, c}}};
}

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

/// Which sides light can reach: spreads from the lamps to what they see, and on from all that
/// reflects. Finds also whether the room is closed.
std::vector<char> find_lit_sides(const Scene& scene, bool& closed, int threads);

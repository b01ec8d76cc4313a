// Meshes of the kinds that users bring: a furnished room, hair.
#pragma once
#include "tests/support/meshes.h"

/// Numbers for a mesh, drawn one after the other.
class MeshRandom {
public:
    explicit MeshRandom(uint32_t seed) : sampler_(SamplerType::independent, seed, 1) {
        sampler_.start(0, 0);
    }
    float between(float low, float high) { return low + (high - low) * sampler_.u1(); }
    Vec3 in_cube() {
        Vec2 u = sampler_.u2();
        return {2 * u.x - 1, 2 * u.y - 1, 2 * sampler_.u1() - 1};
    }

private:
    Sampler sampler_;
};

/// A tube around the line from a to b, from radius ra to rb, of n faces around.
inline void add_tube(Geometry& g, Vec3 a, Vec3 b, float ra, float rb, uint32_t n, uint32_t along) {
    Frame around(normalize(b - a));
    add_surface(g, n, along, [&](float u, float v) {
        float r = ra + (rb - ra) * v;
        Vec3 out = std::cos(2 * pi * u) * around.s + std::sin(2 * pi * u) * around.t;
        return a + v * (b - a) + r * out;
    });
}

/// A cushion: a box with round edges, of 2 n^2 triangles.
inline void add_cushion(Geometry& g, Vec3 centre, Vec3 half, uint32_t n) {
    auto rounded = [](float x) { return std::copysign(std::pow(std::abs(x), 0.3f), x); };
    add_surface(g, n, n, [&](float u, float v) {
        float phi = 2 * pi * u, theta = pi * v, s = rounded(std::sin(theta));
        return centre + Vec3{half.x * s * rounded(std::cos(phi)), half.y * rounded(std::cos(theta)),
                             half.z * s * rounded(std::sin(phi))};
    });
}

/// A chair or a table: a top, four turned legs, and screws of a few micrometres.
inline void add_table(Geometry& g, Vec3 at, Vec3 half, uint32_t detail) {
    add_cushion(g, at + Vec3{0, 2 * half.y, 0}, {half.x, 0.03f, half.z}, detail);
    for (float x : {-0.9f, 0.9f}) {
        for (float z : {-0.9f, 0.9f}) {
            Vec3 foot = at + Vec3{x * half.x, 0, z * half.z};
            add_surface(g, detail, 2 * detail, [&](float u, float v) {
                float r = 0.03f + 0.01f * std::sin(40 * v), phi = 2 * pi * u;
                return foot + Vec3{r * std::cos(phi), 2 * half.y * v, r * std::sin(phi)};
            });
            Vec3 screw = foot + Vec3{0.05f, 0.01f, 0.05f};
            for (int k = 0; k < 6; k++)
                add_bumpy_ball(g, screw + static_cast<float>(k) * Vec3{0, 0.002f, 0},
                               std::pow(0.25f, static_cast<float>(k)) * 1e-3f, 4);
        }
    }
}

/// A room of 6 x 3 x 5: walls of two triangles each, trims of aspect 10^2 to 10^4, and furniture,
/// 1e5 triangles in all with detail 24. The longest edge is a million times the shortest.
inline Geometry furnished_room(uint32_t detail) {
    Geometry g;
    MeshRandom random(21);
    add_box(g, {-3, 0, -2.5f}, {3, 3, 2.5f});
    // Skirting boards, frames, cables, and gaps between planks, along and across the room.
    float widths[] = {0.05f, 0.02f, 5e-3f, 1e-3f, 5e-4f};
    for (float w : widths) {
        float inset = 0.07f + w;
        for (float y : {0.0f, 2.9f - 10 * w}) {
            add_box(g, {-3 + inset, y, -2.5f}, {3 - inset, y + 2 * w, -2.5f + w});
            add_box(g, {-3 + inset, y, 2.5f - w}, {3 - inset, y + 2 * w, 2.5f});
            add_box(g, {3 - w, y, -2.5f + inset}, {3, y + 2 * w, 2.5f - inset});
        }
        add_tube(g, {-2.9f, 1 + 10 * w, -2.4f}, {2.8f, 2.2f - w, 2.3f}, w / 4, w / 4, 6, 1);
    }
    for (int k = 0; k < 60; k++) {
        float x = -2.9f + 0.095f * static_cast<float>(k);
        add_box(g, {x, 0, -2.45f}, {x + 8e-4f, 1e-3f, 2.45f});
    }
    // Furniture that stands and lies about, at odd angles.
    add_table(g, {0.3f, 0, 0.2f}, {0.8f, 0.36f, 0.5f}, detail);
    for (int k = 0; k < 6; k++) {
        float angle = static_cast<float>(k);
        size_t first = g.positions.size();
        add_table(g, {}, {0.22f, 0.22f, 0.22f}, detail / 2);
        add_cushion(g, {0, 0.75f, 0.2f}, {0.2f, 0.25f, 0.02f}, detail);
        for (size_t i = first; i < g.positions.size(); i++) {
            Vec3& p = g.positions[i];
            p = {std::cos(angle) * p.x - std::sin(angle) * p.z + 0.3f + 1.3f * std::cos(angle), p.y,
                 std::sin(angle) * p.x + std::cos(angle) * p.z + 0.2f + 1.1f * std::sin(angle)};
        }
    }
    for (int k = 0; k < 40; k++) {
        Vec3 at = {random.between(-0.4f, 1), 0.78f, random.between(-0.2f, 0.6f)};
        add_bumpy_ball(g, at, random.between(0.005f, 0.04f), detail / 2);
        at = {random.between(-2.8f, -2), 0.3f * static_cast<float>(k % 5) + 0.4f,
              random.between(-2, 2)};
        Vec3 book = {0.08f, random.between(0.1f, 0.14f), random.between(0.005f, 0.02f)};
        add_box(g, at - book, at + book);
    }
    for (int k = 0; k < 3; k++)
        add_cushion(g, {1.9f, 0.35f, -1.5f + 1.2f * static_cast<float>(k)}, {0.45f, 0.3f, 0.55f},
                    3 * detail);
    add_surface(g, 8 * detail, 6 * detail, [](float a, float b) {  // a curtain
        return Vec3{-2.2f + 4.4f * a, 2.8f - 2.7f * b, -2.35f + 0.06f * std::sin(70 * a + 2 * b)};
    });
    return g;
}

/// A ball with n hairs of eight slivers each, about 2000 times as long as wide.
inline Geometry hair(uint32_t n) {
    Geometry g;
    MeshRandom random(24);
    add_bumpy_ball(g, {0, 0, 0}, 0.7f, 60);
    for (uint32_t i = 0; i < n; i++) {
        Vec3 out = normalize(random.in_cube()), bend = 0.3f * random.in_cube();
        Vec3 side = 5e-5f * normalize(cross(out, random.in_cube()));
        float length = random.between(0.2f, 0.6f);
        add_surface(g, 1, 4, [&](float a, float b) {
            return (0.7f + length * b) * out + length * b * b * (bend + Vec3{0, -0.3f, 0}) +
                   (1 - b) * (a - 0.5f) * side;
        });
    }
    return g;
}

// Spheres and disks made meshes, since patches are triangles.
#pragma once
#include <cstdio>
#include <limits>

#include "chapters/26_radiosity/contacts.h"
#include "common/base/position.h"
#include "common/scene/prepare.h"

namespace ch26 {

/// Adds the triangle a b c to the scene's geometry, but for one without area.
inline void add_triangle(Geometry& g, Vec3 a, Vec3 b, Vec3 c, uint32_t shape) {
    if (!(length_squared(cross(b - a, c - a)) >= std::numeric_limits<float>::min())) return;
    uint32_t first = static_cast<uint32_t>(g.positions.size());
    for (Vec3 p : {a, b, c}) {
        g.positions.push_back(p);
        if (!g.normals.empty()) g.normals.push_back({});  // flat
    }
    g.triangles.push_back({{first, first + 1, first + 2}, shape});
}

/// Cuts a triangle of the unit sphere in four, `depth` times.
inline void divide_on_sphere(Vec3 a, Vec3 b, Vec3 c, int depth,
                             std::vector<std::array<Vec3, 3>>& parts) {
    if (depth == 0) return parts.push_back({a, b, c});
    Vec3 d = normalize(b + c), e = normalize(c + a), f = normalize(a + b);
    divide_on_sphere(a, f, e, depth - 1, parts);
    divide_on_sphere(f, b, d, depth - 1, parts);
    divide_on_sphere(e, d, c, depth - 1, parts);
    divide_on_sphere(d, e, f, depth - 1, parts);
}

/// 512 triangles with the area of the sphere: an octahedron, divided.
inline void add_sphere(Geometry& g, const Sphere& sphere, bool inwards) {
    constexpr int depth = 3;
    std::vector<std::array<Vec3, 3>> parts;
    for (int octant = 0; octant < 8; octant++) {
        Vec3 a = {octant & 1 ? -1.0f : 1.0f, 0, 0}, b = {0, octant & 2 ? -1.0f : 1.0f, 0};
        Vec3 c = {0, 0, octant & 4 ? -1.0f : 1.0f};
        if (dot(cross(a, b), c) < 0) std::swap(b, c);  // seen from outside
        divide_on_sphere(a, b, c, depth, parts);
    }
    double area = 0;
    for (const auto& [a, b, c] : parts) area += double{length(cross(b - a, c - a))} / 2;
    float r = sphere.r * static_cast<float>(std::sqrt(4 * std::numbers::pi / area));
    for (auto [a, b, c] : parts) {
        if (inwards) std::swap(b, c);
        add_triangle(g, sphere.c + r * a, sphere.c + r * b, sphere.c + r * c, sphere.shape);
    }
}

/// 32 triangles with the area of the disk.
inline void add_disk(Geometry& g, const Disk& disk) {
    constexpr int sides = 32;
    constexpr double turn = 2 * std::numbers::pi / sides;
    float r = disk.r * static_cast<float>(std::sqrt(turn / std::sin(turn)));
    Frame frame(disk.n);
    auto rim = [&](int i) {
        return disk.c + frame.to_world({r * static_cast<float>(std::cos(turn * i)),
                                        r * static_cast<float>(std::sin(turn * i)), 0});
    };
    for (int i = 0; i < sides; i++)
        add_triangle(g, disk.c, rim(i), rim((i + 1) % sides), disk.shape);
}

/// Throws InputError when the area of the triangles from `first` on is off by more than 1 %, which
/// the rounding of their corners to floats does to a small shape.
inline void check_area(const Scene& scene, uint32_t first, double wanted, uint32_t shape) {
    double area = 0;
    for (uint32_t prim = first; prim < scene.geometry.triangles.size(); prim++) {
        auto t = corners(scene, prim);
        area += double{length(cross(t[1] - t[0], t[2] - t[0]))} / 2;
    }
    if (std::abs(area / wanted - 1) < 0.01) return;
    const Material& m = scene.materials[scene.shapes[shape].material];
    int light = scene.shapes[shape].light;
    Position at = scene.place(m.at);
    if (light >= 0) {
        const Light& l = scene.lights[static_cast<size_t>(light)];
        at = scene.place(l.at);
    }
    char text[150];
    std::snprintf(text, sizeof text,
                  "a sphere or disk of %.3g m^2 is too small to be cut into triangles; chapters "
                  "from 09 on render it",
                  wanted);
    fail(at, text);
}

/// Puts meshes in place of all spheres and disks, and makes the scene ready again: 512 triangles
/// with the area of the sphere, 32 with that of the disk. Returns how many triangles that makes.
/// Throws InputError for a shape so small that the rounding of corners changes its area.
/// tested by  "identity: spheres and disks made meshes keep area, power and the side that shines",
///            "input: a sphere or disk too small to be cut into triangles is refused"
inline size_t tessellate(Scene& scene, int threads) {
    Geometry& g = scene.geometry;
    uint32_t before = static_cast<uint32_t>(g.triangles.size());
    if (before == g.size()) return 0;
    std::vector<uint32_t> first = {before};  // of each sphere and disk, and one more: its triangles
    auto added = [&](uint32_t shape, float r, double area_of_1) {
        check_area(scene, first.back(), area_of_1 * double{r} * double{r}, shape);
        first.push_back(static_cast<uint32_t>(g.triangles.size()));
    };
    for (const Sphere& s : g.spheres) {
        add_sphere(g, s, scene.shapes[s.shape].reverse);
        added(s.shape, s.r, 4 * std::numbers::pi);
        scene.shapes[s.shape].reverse = false;
    }
    for (const Disk& d : g.disks) {
        add_disk(g, d);
        added(d.shape, d.r, std::numbers::pi);
    }
    for (Light& light : scene.lights) {
        if (light.type != LightType::area || light.first_prim < before) continue;
        uint32_t i = light.first_prim - before, last = i + light.prims;
        light.first_prim = first[i], light.prims = first[last] - first[i];
    }
    g.spheres.clear(), g.disks.clear();
    prepare(scene, threads);
    return g.triangles.size() - before;
}

}  // namespace ch26

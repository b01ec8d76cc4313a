#include "common/radiosity/tessellate.h"

#include <cstdio>
#include <limits>

#include "common/base/position.h"
#include "common/scene/prepare.h"

namespace {

/// Adds the triangle a b c to the scene's geometry, and its area, m^2, to `area`.
void add_triangle(Geometry& g, Vec3 a, Vec3 b, Vec3 c, uint32_t shape, double& area) {
    Vec3 sides = cross(b - a, c - a);
    if (!(length_squared(sides) >= std::numeric_limits<float>::min())) return;
    area += double{length(sides)} / 2;
    uint32_t first = static_cast<uint32_t>(g.positions.size());
    for (Vec3 p : {a, b, c}) {
        g.positions.push_back(p);
        if (!g.normals.empty()) g.normals.push_back({});  // flat
    }
    g.triangles.push_back({{first, first + 1, first + 2}, shape});
}

/// Cuts a triangle of the unit sphere in four, `depth` times, and hands out the parts.
template <class Use>
void divide_on_sphere(Vec3 a, Vec3 b, Vec3 c, int depth, const Use& use) {
    if (depth == 0) return use(a, b, c);
    Vec3 d = normalize(b + c), e = normalize(c + a), f = normalize(a + b);
    divide_on_sphere(a, f, e, depth - 1, use);
    divide_on_sphere(f, b, d, depth - 1, use);
    divide_on_sphere(e, d, c, depth - 1, use);
    divide_on_sphere(d, e, f, depth - 1, use);
}

/// 512 triangles with the area of the sphere: an octahedron, divided. Returns their area as floats
/// hold it, m^2.
double add_sphere(Geometry& g, const Sphere& sphere, bool inwards) {
    constexpr int depth = 3;
    std::vector<std::array<Vec3, 3>> parts;
    for (int octant = 0; octant < 8; octant++) {
        Vec3 a = {octant & 1 ? -1.0f : 1.0f, 0, 0}, b = {0, octant & 2 ? -1.0f : 1.0f, 0};
        Vec3 c = {0, 0, octant & 4 ? -1.0f : 1.0f};
        if (dot(cross(a, b), c) < 0) std::swap(b, c);  // seen from outside
        divide_on_sphere(a, b, c, depth, [&](Vec3 p, Vec3 q, Vec3 r) {
            parts.push_back({p, q, r});
        });
    }
    double area = 0;
    for (const auto& [a, b, c] : parts) area += double{length(cross(b - a, c - a))} / 2;
    float r = sphere.r * static_cast<float>(std::sqrt(4 * std::numbers::pi / area));
    double rounded = 0;
    for (auto [a, b, c] : parts) {
        if (inwards) std::swap(b, c);
        add_triangle(g, sphere.c + r * a, sphere.c + r * b, sphere.c + r * c, sphere.shape,
                     rounded);
    }
    return rounded;
}

/// 32 triangles with the area of the disk. Returns their area as floats hold it, m^2.
double add_disk(Geometry& g, const Disk& disk) {
    constexpr int sides = 32;
    constexpr double turn = 2 * std::numbers::pi / sides;
    float r = disk.r * static_cast<float>(std::sqrt(turn / std::sin(turn)));
    Frame frame(disk.n);
    auto rim = [&](int i) {
        return disk.c + frame.to_world({r * static_cast<float>(std::cos(turn * i)),
                                        r * static_cast<float>(std::sin(turn * i)), 0});
    };
    double rounded = 0;
    for (int i = 0; i < sides; i++) {
        add_triangle(g, disk.c, rim(i), rim((i + 1) % sides), disk.shape, rounded);
    }
    return rounded;
}

/// Throws InputError when the rounding of corners to floats has changed the area of a mesh by more
/// than 1 %.
void check_area(const Scene& scene, double area, double wanted, const char* kind, Vec3 c, float r,
                uint32_t shape) {
    if (std::abs(area / wanted - 1) < 0.01) return;
    char text[200];
    std::snprintf(text, sizeof text,
                  "the %s of radius %g at (%g, %g, %g) is too small to be cut into triangles; "
                  "chapters from 09 on render it",
                  kind, double{r}, double{c.x}, double{c.y}, double{c.z});
    const Material& m = scene.materials[scene.shapes[shape].material];
    int light = scene.shapes[shape].light;
    if (light < 0) fail({scene.file, m.line, m.column}, text);
    const Light& l = scene.lights[static_cast<size_t>(light)];
    fail({scene.file, l.line, l.column}, text);
}

}  // namespace

size_t tessellate(Scene& scene, int threads) {
    Geometry& g = scene.geometry;
    uint32_t before = static_cast<uint32_t>(g.triangles.size());
    if (before == g.size()) return 0;
    std::vector<uint32_t> first;  // of each sphere and disk: its first triangle
    auto next = [&] { first.push_back(static_cast<uint32_t>(g.triangles.size())); };
    for (const Sphere& sphere : g.spheres) {
        next();
        Shape& shape = scene.shapes[sphere.shape];
        double area = add_sphere(g, sphere, shape.reverse), r = double{sphere.r};
        check_area(scene, area, 4 * std::numbers::pi * r * r, "sphere", sphere.c, sphere.r,
                   sphere.shape);
        shape.reverse = false;
    }
    for (const Disk& disk : g.disks) {
        next();
        double area = add_disk(g, disk), r = double{disk.r};
        check_area(scene, area, std::numbers::pi * r * r, "disk", disk.c, disk.r, disk.shape);
    }
    next();
    for (Light& light : scene.lights) {
        if (light.type != LightType::area || light.first_prim < before) continue;
        uint32_t i = light.first_prim - before, last = i + light.prims;
        light.first_prim = first[i], light.prims = first[last] - first[i];
    }
    g.spheres.clear(), g.disks.clear();
    prepare(scene, threads);
    return g.triangles.size() - before;
}

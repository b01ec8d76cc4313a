#include "common/path/radiosity.h"

#include "common/base/error.h"
#include "common/base/parallel.h"
#include "common/material/basic_bsdf.h"
#include "common/path/sampler.h"
#include "common/scene/intersect.h"
#include "common/scene/prepare.h"

namespace {

void add_triangle(Geometry& g, Vec3 a, Vec3 b, Vec3 c, uint32_t shape) {
    uint32_t first = static_cast<uint32_t>(g.positions.size());
    for (Vec3 p : {a, b, c}) {
        g.positions.push_back(p);
        if (!g.normals.empty()) g.normals.push_back({});  // flat
    }
    g.triangles.push_back({{first, first + 1, first + 2}, shape});
}

/// Cuts a triangle of the unit sphere in four, `depth` times.
void divide_on_sphere(Vec3 a, Vec3 b, Vec3 c, int depth, std::vector<Corners>& parts) {
    if (depth == 0) return parts.push_back({a, b, c});
    Vec3 d = normalize(b + c), e = normalize(c + a), f = normalize(a + b);
    divide_on_sphere(a, f, e, depth - 1, parts);
    divide_on_sphere(f, b, d, depth - 1, parts);
    divide_on_sphere(e, d, c, depth - 1, parts);
    divide_on_sphere(d, e, f, depth - 1, parts);
}

/// 512 triangles with the area of the sphere: an octahedron, divided.
void add_sphere(Geometry& g, const Sphere& sphere, bool inwards) {
    constexpr int depth = 3;
    std::vector<Corners> parts;
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
void add_disk(Geometry& g, const Disk& disk) {
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

/// Throws InputError for a shape so small that rounding its corners to floats changes its area.
void check_size(const Scene& scene, Vec3 centre, float r, uint32_t shape) {
    if (rounding_error(max_component(abs(centre)) + r) <= r / 20) return;
    fail(scene.place(scene.shapes[shape].at),
         "a sphere or disk this small cannot be cut into triangles; chapters from 09 on render it");
}

/// The sides that rays from this side meet: 2 i is the front of triangle i, 2 i + 1 its back; a
/// number above all of them where a ray leaves the scene.
std::vector<uint32_t> sides_seen(const Scene& scene, uint32_t side) {
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
        seen.push_back(y ? 2 * y->prim + (y->front ? 0 : 1) : 2 * scene.geometry.size());
    }
    return seen;
}

}  // namespace

size_t tessellate(Scene& scene, int threads) {
    Geometry& g = scene.geometry;
    uint32_t before = static_cast<uint32_t>(g.triangles.size());
    if (before == g.size()) return 0;
    std::vector<uint32_t> first = {before};  // of each sphere and disk, and one more: its triangles
    for (const Sphere& s : g.spheres) {
        check_size(scene, s.c, s.r, s.shape);
        add_sphere(g, s, scene.shapes[s.shape].reverse);
        first.push_back(static_cast<uint32_t>(g.triangles.size()));
        scene.shapes[s.shape].reverse = false;
    }
    for (const Disk& d : g.disks) {
        check_size(scene, d.c, d.r, d.shape);
        add_disk(g, d);
        first.push_back(static_cast<uint32_t>(g.triangles.size()));
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

void refuse(const Scene& scene) {
    for (const Light& light : scene.lights) {
        if (light.type == LightType::area) continue;
        fail(scene.place(light.at),
             "radiosity knows lamps with a surface alone; chapters from 09 on render other lights");
    }
    Rgb least = {1, 1, 1};
    for (const Shape& shape : scene.shapes) {
        const Material& m = scene.materials[shape.material];
        if (m.texture != 0 || m.type != MaterialType::diffuse) {
            fail(scene.place(m.at),
                 "radiosity knows diffuse surfaces of one reflectance alone (LD*E); chapters "
                 "13 to 25 render others");
        }
        Rgb rho = m.reflectance;
        least = {std::min(least.r, rho.r), std::min(least.g, rho.g), std::min(least.b, rho.b)};
    }
    if (max_component(least) < 1) return;
    fail({scene.origin->file},
         "radiosity needs a surface that absorbs: in a closed room whose surfaces reflect all "
         "light, it grows with each bounce");
}

std::vector<char> find_lit_sides(const Scene& scene, bool& closed, int threads) {
    size_t outside = 2 * scene.geometry.triangles.size();  // counts as one more side
    std::vector<std::vector<uint32_t>> seen(outside);
    parallel_for(static_cast<int>(outside), threads, [&](int side) {
        seen[static_cast<size_t>(side)] = sides_seen(scene, static_cast<uint32_t>(side));
    });
    std::vector<char> lit(outside + 1), sends(outside + 1);  // sends: what reaches it goes on
    for (uint32_t side = 0; side < outside; side++) {
        lit[side] = !is_black(emitted(scene, side / 2, side % 2 == 0));
        sends[side] = lit[side] || !is_black(reflectance(scene, side / 2));
    }
    for (bool changed = true; changed;) {
        changed = false;
        auto reach = [&](size_t from, size_t to) {
            if (!lit[from] || !sends[from] || lit[to]) return;
            lit[to] = changed = true;
        };
        for (size_t a = 0; a < outside; a++) {
            for (uint32_t b : seen[a]) {
                reach(a, b);
                reach(b, a);  // rays from b may miss a small side
            }
        }
    }
    closed = !lit[outside];
    return lit;
}

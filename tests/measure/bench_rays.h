// The meshes on which make bench measures, and the rays it sends.
#pragma once
#include <functional>
#include <string>

#include "common/geometry/bvh.h"
#include "tests/support/meshes.h"

/// A mesh, where it is seen from, and the middle of a cube of lights.
struct BenchMesh {
    std::string name;
    std::function<Geometry()> make;
    Vec3 eye, at, light;
    float light_size, fov;
};

inline Geometry bumpy_ball(uint32_t n) {
    Geometry g;
    add_bumpy_ball(g, {0, 0, 0}, 1, n);
    return g;
}

inline std::vector<BenchMesh> all_meshes() {
    Vec3 hall_eye = {-9, 1.7f, 0.5f}, hall_at = {5, 2.5f, 0}, hall_light = {0, 7.5f, 0};
    return {
        {"Cornell box",
         cornell_box,
         {0.5f, 0.5f, -1.4f},
         {0.5f, 0.5f, 0},
         {0.5f, 0.98f, 0.5f},
         0.2f,
         39},
        {"thin diagonals",
         [] { return thin_diagonals(20000); },
         {0.5f, 0.5f, -1.8f},
         {0.5f, 0.5f, 0.5f},
         {0.5f, 3, -1},
         0.3f,
         45},
        {"dense corner",
         [] { return dense_corner(100); },
         {0.5f, 3, 0.5f},
         {9, 0.5f, 9},
         {5, 5.5f, 5},
         1,
         60},
        {"ball 1.0 M",
         [] { return bumpy_ball(1000); },
         {0, 0.5f, -3},
         {0, 0, 0},
         {2, 4, -3},
         0.5f,
         45},
        {"hall 68 k", [] { return hall(8); }, hall_eye, hall_at, hall_light, 1, 65},
        {"hall 1.4 M", [] { return hall(36); }, hall_eye, hall_at, hall_light, 1, 65},
    };
}

struct RaySet {
    std::string name;
    bool any;  // asks for any hit, not for the nearest
    std::vector<Ray> rays;
};

/// Where a ray meets the mesh, a bit off the surface, and the normal on the ray's side.
struct Foot {
    Vec3 p, n;
};
inline Foot foot_of(const Geometry& g, const Ray& ray, const PrimHit& hit) {
    auto [a, b, c] = g.triangles[hit.prim].v;
    Vec3 n = cross(g.positions[b] - g.positions[a], g.positions[c] - g.positions[a]);
    n = normalize(dot(n, ray.d) > 0 ? -n : n);
    return {ray.o + hit.t * ray.d + 1e-4f * n, n};
}

/// From the camera; from where those hit, in proportion to the cosine, and once more from there;
/// and from where the first hit to the lights.
inline std::vector<RaySet> rays_for(const BenchMesh& mesh, const Geometry& g, const Bvh& bvh,
                                    int size) {
    std::vector<RaySet> sets = {{"primary", false, {}},
                                {"bounce", false, {}},
                                {"second bounce", false, {}},
                                {"shadow", true, {}}};
    Vec3 w = normalize(mesh.at - mesh.eye), u = normalize(cross({0, 1, 0}, w)), v = cross(w, u);
    float half = std::tan(mesh.fov * pi / 360), pixels = static_cast<float>(size);
    Sampler sampler(SamplerType::independent, 3, 1);
    for (int i = 0; i < size * size; i++) {
        sampler.start(static_cast<uint32_t>(i), 0);
        Vec2 in_pixel = sampler.u2();
        float x = (static_cast<float>(i % size) + in_pixel.x) / pixels;
        float y = (static_cast<float>(i / size) + in_pixel.y) / pixels;
        Ray ray = {mesh.eye, normalize(w + half * (2 * x - 1) * u + half * (1 - 2 * y) * v)};
        sets[0].rays.push_back(ray);
        for (size_t bounce = 1; bounce <= 2; bounce++) {
            PrimHit hit = closest_hit(bvh, g, ray);
            if (hit.prim == PrimHit::none) break;
            Foot foot = foot_of(g, ray, hit);
            if (bounce == 1) {
                Vec2 a = sampler.u2();
                Vec3 in_cube = {a.x - 0.5f, a.y - 0.5f, sampler.u1() - 0.5f};
                Vec3 to_light = mesh.light + mesh.light_size * in_cube - foot.p;
                sets[3].rays.push_back({foot.p, to_light, 0.999f});
            }
            Vec2 b = sampler.u2();
            float z = 2 * b.x - 1, r = std::sqrt(1 - z * z), phi = 2 * pi * b.y;
            Vec3 on_sphere = {r * std::cos(phi), r * std::sin(phi), z};
            ray = {foot.p, normalize(foot.n + 0.999f * on_sphere)};
            sets[bounce].rays.push_back(ray);
        }
    }
    return sets;
}

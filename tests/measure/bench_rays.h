// The meshes on which make bench measures, and the rays it sends.
#pragma once
#include <functional>
#include <string>

#include "common/geometry/bvh.h"
#include "tests/support/room_meshes.h"

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
        {"furnished room",
         [] { return furnished_room(24); },
         {-2.6f, 1.6f, 1.9f},
         {1, 0.8f, -0.5f},
         {0, 2.8f, 0},
         0.5f,
         65},
        {"scan", [] { return scan(7); }, {0, 0.6f, -3.4f}, {0, 0, 0}, {3, 5, -4}, 0.5f, 45},
        {"tree", [] { return tree(5, 40); }, {0, 2, -9}, {0, 3.6f, 0}, {10, 20, -10}, 2, 50},
        {"hair", [] { return hair(20000); }, {0, 0.5f, -3.5f}, {0, 0, 0}, {2, 4, -3}, 0.5f, 40},
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

/// The six sides of a mesh's box are so far apart, at the most.
inline float size_of(const Geometry& g) {
    Vec3 low = {infinity, infinity, infinity}, high = -low;
    for (Vec3 p : g.positions) low = min(low, p), high = max(high, p);
    return max_component(high - low);
}

/// The kinds of rays. From the camera; from where those hit, in proportion to the cosine, and once
/// more from there; along an axis through the camera's film. From where the first hit: to the
/// lights; to a light that is near; and a short way up (ambient occlusion).
inline std::vector<RaySet> rays_for(const BenchMesh& mesh, const Geometry& g, const Bvh& bvh,
                                    int size) {
    std::vector<RaySet> sets = {{"primary", false, {}},       {"bounce", false, {}},
                                {"second bounce", false, {}}, {"axis-parallel", false, {}},
                                {"shadow", true, {}},         {"near light", true, {}},
                                {"short", true, {}}};
    Vec3 w = normalize(mesh.at - mesh.eye), u = normalize(cross({0, 1, 0}, w)), v = cross(w, u);
    float half = std::tan(mesh.fov * pi / 360), pixels = static_cast<float>(size);
    float mesh_size = size_of(g);
    Sampler sampler(SamplerType::independent, 3, 1);
    for (int i = 0; i < size * size; i++) {
        sampler.start(static_cast<uint32_t>(i), 0);
        Vec2 in_pixel = sampler.u2();
        float x = (static_cast<float>(i % size) + in_pixel.x) / pixels;
        float y = (static_cast<float>(i / size) + in_pixel.y) / pixels;
        Vec3 on_film = w + half * (2 * x - 1) * u + half * (1 - 2 * y) * v;
        Ray ray = {mesh.eye, normalize(on_film)};
        sets[0].rays.push_back(ray);
        Vec3 axis;
        axis[i % 3] = i % 2 == 0 ? 1.0f : -1.0f;
        sets[3].rays.push_back({mesh.eye + length(mesh.at - mesh.eye) * on_film, axis});
        auto cube = [&] {
            Vec2 a = sampler.u2();
            return Vec3{a.x - 0.5f, a.y - 0.5f, sampler.u1() - 0.5f};
        };
        for (size_t bounce = 1; bounce <= 2; bounce++) {
            PrimHit hit = closest_hit(bvh, g, ray);
            if (hit.prim == PrimHit::none) break;
            Foot foot = foot_of(g, ray, hit);
            auto towards_cosine = [&] {
                Vec2 b = sampler.u2();
                float z = 2 * b.x - 1, r = std::sqrt(1 - z * z), phi = 2 * pi * b.y;
                Vec3 on_sphere = {r * std::cos(phi), r * std::sin(phi), z};
                return normalize(foot.n + 0.999f * on_sphere);
            };
            if (bounce == 1) {
                Vec3 to_light = mesh.light + mesh.light_size * cube() - foot.p;
                sets[4].rays.push_back({foot.p, to_light, 0.999f});
                Vec3 lamp = foot.p + 0.1f * mesh_size * foot.n + 0.2f * mesh_size * cube();
                sets[5].rays.push_back({foot.p, lamp - foot.p, 0.999f});
                sets[6].rays.push_back({foot.p, towards_cosine(), 0.05f * mesh_size});
            }
            ray = {foot.p, towards_cosine()};
            sets[bounce].rays.push_back(ray);
        }
    }
    return sets;
}

// Every hit of the hierarchy against a yardstick that shares no code with it: each triangle by
// itself, in long double, without shear and without boxes.
#include <doctest/doctest.h>

#include "common/geometry/bvh_build.h"
#include "common/geometry/shapes.h"
#include "common/scene/intersect.h"
#include "common/scene/prepare.h"
#include "tests/support/room_meshes.h"

namespace {

using Real = long double;

struct V {
    Real x, y, z;
};
V to_v(Vec3 a) { return {Real{a.x}, Real{a.y}, Real{a.z}}; }
V operator-(V a, V b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Real dot(V a, V b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
V cross(V a, V b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
Real length(V a) { return std::sqrt(dot(a, a)); }

/// Where a line meets the plane of a triangle, and how far outside of the triangle it passes there:
/// measured across the line, in parts of the distance of the farthest corner; negative inside.
struct Met {
    Real t, outside;
};
Met meet(const Geometry& g, const Triangle& triangle, const Ray& ray) {
    V o = to_v(ray.o), d = to_v(ray.d), p[3];
    Real far = 0;
    for (int k = 0; k < 3; k++) {
        p[k] = to_v(g.positions[triangle.v[k]]) - o;
        far = std::max(far, length(p[k]));
    }
    V n = cross(p[1] - p[0], p[2] - p[0]);
    Real t = dot(n, p[0]) / dot(n, d), outside = -1, turn = dot(n, d) < 0 ? 1 : -1;
    for (int k = 0; k < 3; k++) {
        V a = p[k], side = p[(k + 1) % 3] - a, across = cross(side, d);
        Real size = length(across);
        if (size > 0) outside = std::max(outside, turn * dot(a, across) / size / far);
    }
    return {t, outside};
}

/// A mesh of n triangles, each with one side `aspect` times its height.
Geometry slivers(uint32_t n, float aspect) {
    Geometry g;
    MeshRandom random(5);
    for (uint32_t i = 0; i < n; i++) {
        Vec3 centre = random.in_cube(), along = normalize(random.in_cube());
        Vec3 across = normalize(cross(along, random.in_cube()));
        g.positions.insert(g.positions.end(), {centre - 0.5f * along, centre + 0.5f * along,
                                               centre + (1 / aspect) * across});
        g.triangles.push_back({{3 * i, 3 * i + 1, 3 * i + 2}, 0});
    }
    return g;
}

Geometry scaled(Geometry g, float s) {
    for (Vec3& p : g.positions) p = s * p;
    return g;
}

/// A floor of size 2e6 under a ball of size 0.2.
Geometry ball_on_a_plain() {
    Geometry g;
    add_parallelogram(g, {-1e6f, 0, -1e6f}, {2e6f, 0, 0}, {0, 0, 2e6f});
    add_bumpy_ball(g, {0.03f, 0.1f, 0.02f}, 0.1f, 30);
    return g;
}

std::vector<Geometry> meshes() {
    return {furnished_room(2),
            closed_mesh(3),
            hair(60),
            slivers(300, 1e2f),
            slivers(300, 1e4f),
            slivers(300, 1e6f),
            ball_on_a_plain(),
            scaled(furnished_room(2), 1e-6f),
            scaled(slivers(300, 1e4f), 1e6f)};
}

Scene scene_of(const Geometry& g) {
    Scene scene;
    scene.materials.emplace_back();
    scene.shapes.emplace_back();
    scene.geometry = g;
    prepare(scene, 1);
    return scene;
}

/// A point of a triangle drawn by number, and not by area, so that thin and small ones come up.
Vec3 on_triangle(const Geometry& g, MeshRandom& random) {
    auto last = static_cast<float>(g.triangles.size()) - 0.5f;
    auto [a, b, c] = g.triangles[static_cast<size_t>(random.between(0, last))].v;
    float u = std::sqrt(random.between(0, 1)), v = random.between(0, 1);
    return (1 - u) * g.positions[a] + u * (1 - v) * g.positions[b] + u * v * g.positions[c];
}

}  // namespace

TEST_SUITE("ch06 exact hits") {
    TEST_CASE("truth: every hit as in double precision" * doctest::skip()) {
        constexpr Real rounding = 64 * 0x1p-24L;  // of a corner, in parts of its distance
        for (const Geometry& g : meshes()) {
            Bvh bvh = build_bvh(g, 1);
            MeshRandom random(7);
            int hits = 0, ghosts = 0, lost = 0, off = 0, open = 0;
            for (int i = 0; i < 1500; i++) {
                // From one triangle to another, from near it and from far away.
                Vec3 to = on_triangle(g, random), from = on_triangle(g, random);
                Vec3 o = from + std::exp2(random.between(-10, 4)) * (from - to);
                Ray ray = {o, to - o};
                PrimHit found = closest_hit(bvh, g, ray);
                Real nearest = Real{infinity};
                for (const Triangle& triangle : g.triangles) {
                    Met met = meet(g, triangle, ray);
                    if (met.outside < -rounding && met.t > 0) nearest = std::min(nearest, met.t);
                }
                bool hit = found.prim != PrimHit::none;
                open += any_hit(bvh, g, ray) != hit;
                // What is surely in the way must be found, or something before it.
                Real reach = hit ? Real{found.t} : Real{infinity};
                lost += nearest * (1 + 0x1p-7L) < reach;
                if (!hit) continue;
                hits++;
                Met met = meet(g, g.triangles[found.prim], ray);
                ghosts += !(met.outside < rounding);
                off += met.outside < 0 && !(std::abs(met.t - reach) <= 0x1p-8L * met.t);
            }
            CHECK(hits > 500);
            CHECK(ghosts == 0);
            CHECK(lost == 0);
            CHECK(off == 0);
            CHECK(open == 0);
        }
    }

    TEST_CASE("truth: no ray meets the triangle that it leaves") {
        for (const Geometry& g : meshes()) {
            Scene scene = scene_of(g);
            MeshRandom random(8);
            int left = 0, again = 0;
            for (int i = 0; i < 20000; i++) {
                Vec3 to = on_triangle(g, random), from = on_triangle(g, random);
                auto x = intersect(scene, {from, to - from});
                if (!x) continue;
                // Any direction on the front side, half of them nearly along the surface.
                Vec3 wi = normalize(random.in_cube());
                float cos = dot(wi, x->ng);
                if (i % 2 == 0) wi = normalize(wi - (1 - random.between(0, 1e-3f)) * cos * x->ng);
                if (dot(wi, x->ng) < 0) wi = -wi;
                Ray ray = spawn_ray(*x, wi), unaware = ray;
                unaware.from = PrimHit::none;
                left++;
                PrimHit next = closest_hit(scene.bvh, scene.geometry, ray);
                again += next.prim == x->prim;
                again += closest_hit(scene.bvh, scene.geometry, unaware).prim == x->prim;
                // A shadow ray that ends before the next hit meets nothing.
                if (next.prim != PrimHit::none) ray.t_max = 0.99f * next.t;
                again += next.prim != x->prim && any_hit(scene.bvh, scene.geometry, ray);
            }
            CHECK(left > 10000);
            CHECK(again == 0);
        }
    }
}

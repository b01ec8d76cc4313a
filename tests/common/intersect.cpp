// Frames, the shapes' own tests, what a hit says, and leaving a surface without meeting it again.
#include "common/scene/intersect.h"

#include <doctest/doctest.h>

#include "chapters/07_path_tracing/estimator.h"
#include "common/geometry/bvh.h"
#include "common/geometry/shapes.h"
#include "common/scene/intersect.h"
#include "tests/support/gates.h"
#include "tests/support/meshes.h"
#include "tests/support/scenes.h"

namespace {

double to_double(float x) { return static_cast<double>(x); }

/// Where a line meets the plane of a triangle, and how far outside of the triangle it passes there:
/// across the line, in parts of the distance of the farthest corner; negative inside. In double
/// precision, without shear and without boxes.
std::pair<double, double> meet(const Geometry& g, const Triangle& triangle, const Ray& ray) {
    Vec3d o(ray.o), d(ray.d), p[3];
    double far = 0;
    for (size_t k = 0; k < 3; k++) {
        p[k] = Vec3d(g.positions[triangle.v[k]]) - o;
        far = std::max(far, length(p[k]));
    }
    Vec3d n = cross(p[1] - p[0], p[2] - p[0]);
    double t = dot(n, p[0]) / dot(n, d), outside = -1, turn = dot(n, d) < 0 ? 1 : -1;
    for (size_t k = 0; k < 3; k++) {
        Vec3d across = cross(p[(k + 1) % 3] - p[k], d);
        outside = std::max(outside, turn * dot(p[k], across) / length(across) / far);
    }
    return {t, outside};
}

/// Triangles with one side of length 1, and a height of 1 / aspect.
Geometry slivers(float aspect) {
    Geometry g;
    Sampler random = random_numbers(5);
    for (uint32_t i = 0; i < 900; i += 3) {
        Vec3 centre = uniform_direction(random.u2()), along = uniform_direction(random.u2());
        Vec3 across = normalize(cross(along, uniform_direction(random.u2())));
        g.positions.insert(g.positions.end(), {centre - 0.5f * along, centre + 0.5f * along,
                                               centre + (1 / aspect) * across});
        g.triangles.push_back({{i, i + 1, i + 2}, 0});
    }
    return g;
}

/// A point of a triangle drawn by number, and not by area, so that thin and small ones come up.
Vec3 on_triangle(const Geometry& g, Sampler& random) {
    float i = random.u1() * static_cast<float>(g.triangles.size());
    auto [a, b, c] = g.triangles[static_cast<size_t>(i)].v;
    float u = std::sqrt(random.u1()), v = random.u1();
    return (1 - u) * g.positions[a] + u * (1 - v) * g.positions[b] + u * v * g.positions[c];
}

/// Calls visit(scene, ray) for rays from one triangle of a mesh to another, from near it and from
/// far away.
template <class Visit>
void for_rays_to_thin_meshes(const Visit& visit) {
    for (const Geometry& g :
         {closed_mesh(0), closed_mesh(2), closed_mesh(3), thin_diagonals(300), slivers(1),
          slivers(10), slivers(1e2f), slivers(1e3f), slivers(1e4f), slivers(1e6f)}) {
        Scene scene;
        scene.materials.emplace_back(), scene.shapes.emplace_back();
        scene.geometry = g;
        prepare(scene, 1);
        Sampler random = random_numbers(7);
        for (int i = 0; i < 800; i++) {
            Vec3 to = on_triangle(g, random), from = on_triangle(g, random);
            Vec3 o = from + std::exp2(14 * random.u1() - 10) * (from - to);
            visit(scene, {o, to - o});
        }
    }
}

}  // namespace

TEST_SUITE("intersect") {
    TEST_CASE("identity: the frame is orthonormal, also where its formula is nearly infinite") {
        Sampler random = random_numbers(1);
        float worst = 0;
        for (int i = 0; i < 100000; i++) {
            Vec3 n = uniform_direction(random.u2());
            if (i % 2 == 0) n = normalize({1e-3f * n.x, 1e-3f * n.y, n.z});
            Frame f(n);
            for (float error : {dot(f.s, f.t), dot(f.s, n), dot(f.t, n), length(f.s) - 1,
                                length(f.t) - 1, length(cross(f.s, f.t) - n)})
                worst = std::isfinite(error) ? std::max(worst, std::abs(error)) : infinity;
        }
        CHECK(worst < 1e-6f);
    }

    TEST_CASE("truth: a small sphere far away keeps its edge and its distance") {
        // In float, b^2 - a c would be wrong by about 10 here, for a radius of 1.
        Sampler random = random_numbers(1);
        constexpr double distance = 1e4;
        for (int i = 0; i < 10000; i++) {
            Vec3 c = 1e4f * uniform_direction(random.u2());
            Frame around(normalize(c));
            float b = 1.5f * random.u1();
            Vec3 d = normalize(c + b * around.s);
            auto t = intersect_sphere({{0, 0, 0}, d}, c, 1);
            if (b > 1.01f) CHECK_FALSE(t);
            if (b > 0.9f) continue;
            REQUIRE(t);
            CHECK(std::abs(to_double(*t) - (distance - std::sqrt(1 - to_double(b) * b))) < 0.01);
        }
    }

    TEST_CASE("truth: tiny balls are met just before the ray's origin, and from inside") {
        Sampler random = random_numbers(1);
        for (float r : {1e-7f, 1e-5f, 1e-3f, 1.0f})
            for (int i = 0; i < 200; i++) {
                CAPTURE(r);
                Vec3 d = uniform_direction(random.u2());
                float length_of_d = i % 2 == 0 ? 1 : 1e-3f;  // t counts lengths of d
                Ray ray = {{0, 0, 0}, length_of_d * d};
                for (float centre : {0.5f, 1.001f, 1.5f, 3.0f}) {  // in radii
                    auto t = intersect_sphere(ray, centre * r * d, r);
                    REQUIRE(t);
                    float truth = centre < 1 ? centre + 1 : centre - 1;
                    CHECK(std::abs(*t * length_of_d / r - truth) < 1e-5f);
                    CHECK_FALSE(intersect_sphere({ray.o, ray.d, 0.99f * *t}, centre * r * d, r));
                }
                CHECK_FALSE(intersect_sphere(ray, -1.5f * r * d, r));
            }
    }

    TEST_CASE("truth: a ray that leaves a thin trim does not meet it, and misses what is far off") {
        // In float t is 3.2e-5, in double precision -3.7e-6.
        Vec3 corner = {0x1.3fbe76p+1f, 0x1.656e6ap+1f, -0x1.f024c4p+0f};
        Vec3 d = {0x1.abdbp-1f, -0x1.8f5e66p-2f, 0x1.8c079p-2f};
        Ray leaves = {{-0x1.3a5396p+0f, 0x1.656e5ep+1f, -0x1.f026ccp+0f}, d};
        CHECK_FALSE(intersect_triangle(leaves, shear_to_ray(d), corner,
                                       {-corner.x, corner.y, corner.z},
                                       {-corner.x, corner.y, -0x1.f0506ap+0f}));
        // This one passes 28 units from a triangle of size 0.0008, and two of its areas round to 0.
        d = {0x1.71f122p-2f, 0x1.4f03fcp-2f, -0x1.c7eca4p-1f};
        Ray passes = {{-0x1.2bbb02p+5f, -0x1.3a7f9ap-1f, 0x1.00fa7ep+5f}, d};
        CHECK_FALSE(intersect_triangle(passes, shear_to_ray(d),
                                       {0x1.7306p+1f, 0x1.185154p+1f, -0x1.3df352p+0f},
                                       {0x1.7304acp+1f, 0x1.1855dap+1f, -0x1.3e031cp+0f},
                                       {0x1.72ecdp+1f, 0x1.185692p+1f, -0x1.3de4f8p+0f}));
    }

    TEST_CASE("brute: no ray leaks through a closed mesh") {
        for (Vec3 offset : {Vec3{0, 0, 0}, {148376, 1234, -223423}}) {
            Geometry g = closed_mesh(3);
            float size = offset.x == 0 ? 1.0f : 1000.0f;
            for (Vec3& p : g.positions) p = size * p + offset;
            Bvh bvh = build_bvh(g, 1);
            Sampler random = random_numbers(1);
            int leaks = 0, disagreements = 0, late = 0;
            for (int i = 0; i < 40000; i++) {
                // Aim at a point of an edge, or at a corner, from around the middle; or from
                // outside through them to the middle.
                const Triangle& t = g.triangles[static_cast<size_t>(i) % g.triangles.size()];
                Vec3 a = g.positions[t.v[0]], b = g.positions[t.v[1]];
                Vec3 from = offset + 0.2f * size * uniform_direction(random.u2());
                Vec3 at = i % 4 == 0 ? a : a + random.u1() * (b - a);
                bool from_outside = i % 8 < 4;
                if (from_outside) from = at + (at - offset);
                Ray ray = {from, from_outside ? offset - at : at - from};
                PrimHit brute = linear_scan(g, ray), found = closest_hit(bvh, g, ray);
                leaks += brute.prim == PrimHit::none;
                leaks += !any_hit(bvh, g, ray);
                disagreements += !same_hit(found, brute);
                late += from_outside && found.t > 1.001f;  // not the first wall
            }
            CHECK(leaks == 0);
            CHECK(disagreements == 0);
            CHECK(late == 0);
        }
    }

    TEST_CASE("truth: every hit as in double precision") {
        constexpr double rounding = 64 * 0x1p-24;  // of a corner, in parts of its distance
        int hits = 0, ghosts = 0, lost = 0, off = 0, open = 0;
        for_rays_to_thin_meshes([&](const Scene& scene, const Ray& ray) {
            const Geometry& g = scene.geometry;
            auto x = intersect(scene, ray);
            double nearest = double{infinity}, reach = x ? double{x->t} : nearest;
            for (const Triangle& triangle : g.triangles) {
                auto [t, outside] = meet(g, triangle, ray);
                if (outside < -rounding && t > 0) nearest = std::min(nearest, t);
            }
            open += occluded(scene, ray) != x.has_value();
            // What is surely in the way must be found, or something before it.
            lost += nearest * (1 + 0x1p-7) < reach;
            if (!x) return;
            hits++;
            auto [t, outside] = meet(g, g.triangles[x->prim], ray);
            ghosts += !(outside < rounding);
            off += outside < 0 && !(std::abs(t - reach) <= 0x1p-8 * t);
        });
        CHECK(hits > 2000);
        for (int wrong : {ghosts, lost, off, open}) CHECK(wrong == 0);
    }

    TEST_CASE("truth: no ray meets the triangle that it leaves") {
        Sampler random = random_numbers(8);
        int left = 0, again = 0;
        for_rays_to_thin_meshes([&](const Scene& scene, const Ray& ray) {
            auto x = intersect(scene, ray);
            if (!x) return;
            // Any direction on the front side, half of them nearly along the surface.
            Vec3 wi = uniform_direction(random.u2());
            float cos = dot(wi, x->ng);
            if (left++ % 2 == 0) wi = normalize(wi - (1 - 1e-3f * random.u1()) * cos * x->ng);
            Ray leaves = spawn_ray(*x, dot(wi, x->ng) < 0 ? -wi : wi), unaware = leaves;
            unaware.from = PrimHit::none;
            for (const Ray& next : {leaves, unaware})
                again += closest_hit(*scene.bvh, scene.geometry, next).prim == x->prim;
        });
        CHECK(left > 2000);
        CHECK(again == 0);
    }

    TEST_CASE("identity: a smoothed normal bends, but never away from the viewer") {
        Scene scene = world_of(
            "LightSource \"infinite\"\n"
            "Shape \"trianglemesh\" \"point3 P\" [0 0 0  1 0 0  0 1 0] \"integer indices\" [0 1 2]"
            " \"normal N\" [-2 0 1  2 0 1  0 0 1]");
        const Vec3 down = {0, 0, -1}, grazing = normalize({-1, 0, -0.3f});
        struct {
            float x, y;
            Vec3 d, n;
        } cases[] = {
            {0.25f, 0.25f, down, {-0.5f, 0, 1}},  {0.5f, 0.2f, down, {0.4f, 0, 1}},
            {0.2f, 0.5f, down, {-0.2f, 0, 1}},    {0.25f, 0.25f, -down, {0.5f, 0, -1}},
            {0.01f, 0.01f, down, {-1.94f, 0, 1}}, {0.01f, 0.01f, grazing, {0, 0, 1}},
        };
        for (const auto& c : cases) {
            Hit x = *intersect(scene, {Vec3{c.x, c.y, 0} - c.d, c.d});
            CHECK(length(x.n - normalize(c.n)) < 1e-6f);
            CHECK(x.ng == Vec3{0, 0, c.d.z < 0 ? 1.0f : -1.0f});
            // As who sees the point from another side than its ray has it.
            Vec3 smooth = c.d == grazing ? Vec3{-1.94f, 0, 1} : c.n;
            CHECK(length(smooth_normal(scene, x) - normalize(smooth)) < 1e-5f);
        }
    }

    TEST_CASE("identity: a ray leaves on the side of the surface to which it goes") {
        Sampler random = random_numbers(1);
        int bent = 0;
        for (int i = 0; i < 1000; i++) {
            Hit x{};
            x.eps = 0.01f;
            x.ng = uniform_direction(random.u2());
            x.n = normalize(x.ng + 0.9f * uniform_direction(random.u2()));
            Vec3 wi = uniform_direction(random.u2());
            CHECK(dot(spawn_ray(x, wi).o, x.ng) * dot(wi, x.ng) > 0);
            bent += dot(wi, x.ng) * dot(wi, x.n) < 0;  // a mirror may send a path there
        }
        CHECK(bent > 50);
    }

    TEST_CASE("truth: a hit lies on its surface to within its eps, and eps is small") {
        Sampler random = random_numbers(1);
        Scene scene = world_of("LightSource \"infinite\" Shape \"sphere\"");
        auto& [c, r, shape] = scene.geometry.spheres[0];
        for (auto [centre, radius] : {std::pair{0.0f, 1.0f},
                                      {1e4f, 1.0f},
                                      {556.0f, 30.0f},
                                      {0.0f, 1e-3f},
                                      {1e-3f, 1e-4f}}) {
            c = {centre, -centre, centre / 2}, r = radius;
            prepare(scene, 1);
            int hits = 0;
            for (int i = 0; i < 2000; i++) {
                // From nearby and from far away, towards a point inside.
                Vec3 from = (i % 2 == 0 ? 3 : 1e4f) * r * uniform_direction(random.u2());
                Vec3 to = 0.9f * r * uniform_direction(random.u2());
                auto x = intersect(scene, {c + from, normalize(to - from)});
                if (!x) continue;  // so far away, rounding can make a ray miss
                hits++;
                CHECK(std::abs(length(Vec3d(x->p) - Vec3d(c)) - double{r}) <= double{x->eps});
                CHECK(x->eps <= 1e-6f * (centre + r));
            }
            CHECK(hits > 1900);
        }
    }

    TEST_CASE("failure: no light leaks into a closed box, of any size and anywhere") {
        // What gets in would be seen: the sky outside is a million, the inside exactly black. (A
        // vertex that lies exactly on an edge does leak: one bounce in ten million, seed 1 has it.)
        for (float size : {1e-3f, 1.0f, 556.0f, 1e5f}) {
            for (float away : {0.0f, 10.0f}) {
                Scene scene = world_of(
                    "LightSource \"infinite\" \"float scale\" 1e6\n"
                    "Material \"diffuse\" \"rgb reflectance\" [1 1 1]\n"
                    "Shape \"trianglemesh\" \"integer indices\" [0 1 3 0 3 2 4 6 7 4 7 5 0 4 5 0 5 "
                    "1"
                    " 2 3 7 2 7 6 0 2 6 0 6 4 1 5 7 1 7 3]\n \"point3 P\" [-1 -1 -1  1 -1 -1"
                    "  -1 1 -1  1 1 -1  -1 -1 1  1 -1 1  -1 1 1  1 1 1]");
                Vec3 centre = size * away * Vec3{1, 0.3f, 0.7f};
                for (Vec3& p : scene.geometry.positions) p = centre + size * p;
                scene.camera.o = centre;
                scene.max_depth = 20;
                prepare(scene, 1);
                Rendering r = film_of(scene, ch07::trace, 16, 2);
                CHECK(r.film.mean() == 0);
                CHECK(r.stats.paths_cut == 16 * 32 * 32);
            }
        }
    }
}

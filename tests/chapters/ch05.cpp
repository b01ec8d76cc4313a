// Chapter 05: every step finds the same hits, with less and less work.
#include <doctest/doctest.h>

#include "chapters/05_bvh/estimator.h"
#include "common/path/sampler.h"
#include "tests/support/gates.h"

namespace {

Vec3 random_point(Sampler& sampler) {
    Vec2 u = sampler.u2();
    return {2 * u.x - 1, 2 * u.y - 1, 2 * sampler.u1() - 1};
}

/// Small random triangles, some large ones, and a few spheres and disks.
Scene clutter(uint32_t triangles) {
    Scene scene;
    Geometry& g = scene.geometry;
    Sampler sampler(SamplerType::independent, 5, 1);
    for (uint32_t i = 0; i < triangles; i++) {
        sampler.start(i, 0);
        Vec3 centre = random_point(sampler);
        float size = i % 50 == 0 ? 1.0f : 0.1f;
        for (int k = 0; k < 3; k++) g.positions.push_back(centre + size * random_point(sampler));
        g.triangles.push_back({{3 * i, 3 * i + 1, 3 * i + 2}, 0});
    }
    g.spheres = {{{0.3f, 0.2f, 0.1f}, 0.2f, 0}, {{-0.5f, 0, 0}, 0.3f, 0}};
    g.disks = {{{0, 0.5f, 0}, normalize({1, 1, 0}), 0.4f, 0}};
    return scene;
}

/// Random rays; every fourth is parallel to an axis, with zeros of either sign.
Ray ray_number(uint32_t i) {
    Sampler sampler(SamplerType::independent, 6, 1);
    sampler.start(i, 0);
    Vec3 o = 2 * random_point(sampler), d = random_point(sampler) - o;
    if (i % 4 == 0) {
        Vec3 axis = {0.0f, -0.0f, 0.0f};
        axis[static_cast<int>(i / 4 % 3)] = i % 8 == 0 ? 1.0f : -1.0f;
        d = axis;
    }
    return {o, d};
}

std::vector<ch05::Finder> all_finders(const Scene& scene) {
    std::vector<ch05::Finder> finders;
    for (size_t step = 0; step < ch05::step_names.size(); step++) {
        finders.push_back(make_finder(scene, static_cast<ch05::Step>(step)));
    }
    return finders;
}

}  // namespace

TEST_SUITE("ch05 bvh") {
    TEST_CASE("brute: every step finds what the linear scan finds, bit for bit") {
        Scene scene = clutter(500);
        std::vector<ch05::Finder> finders = all_finders(scene);
        int hits = 0;
        for (uint32_t i = 0; i < 20000; i++) {
            Ray ray = ray_number(i);
            PrimHit truth = linear_scan(scene.geometry, ray);
            hits += truth.prim != PrimHit::none;
            for (const ch05::Finder& finder : finders) {
                ch05::Work work;
                PrimHit hit = find(finder, scene.geometry, ray, work);
                CAPTURE(ch05::step_names[static_cast<size_t>(finder.step)]);
                REQUIRE(hit.prim == truth.prim);
                if (hit.prim == PrimHit::none) continue;
                REQUIRE(hit.t == truth.t);
                REQUIRE(hit.b1 == truth.b1);
                REQUIRE(hit.b2 == truth.b2);
            }
        }
        CHECK(hits > 5000);
        CHECK(hits < 19000);
    }

    TEST_CASE("variance: each step does less work than the one before") {
        Scene scene = clutter(5000);
        std::vector<uint64_t> work;
        for (const ch05::Finder& finder : all_finders(scene)) {
            ch05::Work sum;
            for (uint32_t i = 0; i < 1000; i++) find(finder, scene.geometry, ray_number(i), sum);
            work.push_back(sum.boxes + sum.prims);
        }
        CHECK(work[1] < work[0] / 10);
        CHECK(work[2] < work[1]);
        CHECK(work[3] < work[2]);
        CHECK(work[4] < work[3]);
    }

    TEST_CASE("truth: the SAH cost of a root parted into two cubes is 1 + 12/10") {
        ch05::Hierarchy h;
        ch05::Box root, left, right;
        left.add(Vec3{0, 0, 0}), left.add(Vec3{1, 1, 1});
        right.add(Vec3{1, 0, 0}), right.add(Vec3{2, 1, 1});
        root.add(left), root.add(right);
        h.nodes = {{root, 2, 0}, {left, 0, 1}, {right, 1, 1}};
        CHECK(sah_cost(h) == doctest::Approx(1 + 1.2).scale(0));
    }

    TEST_CASE("truth: a box in its sphere is met by 2 / pi of the lines") {
        ch05::Box cube;
        cube.add(Vec3{-1, -1, -1}), cube.add(Vec3{1, 1, 1});
        Sampler sampler(SamplerType::independent, 7, 1);
        constexpr uint32_t n = 1000000;
        RunningStats met;
        for (uint32_t i = 0; i < n; i++) {
            // An isotropic line through the sphere: a direction, and a point of the disk across it.
            sampler.start(i, 0);
            Vec2 u = sampler.u2(), v = sampler.u2();
            float z = 2 * u.x - 1, r = std::sqrt(1 - z * z), phi = 2 * pi * u.y;
            Vec3 d = {r * std::cos(phi), r * std::sin(phi), z};
            Frame frame(d);
            float radius = std::sqrt(3 * v.x), angle = 2 * pi * v.y;
            Vec3 across = radius * std::cos(angle) * frame.s + radius * std::sin(angle) * frame.t;
            Ray ray{across - 4 * d, d};
            met.add(enter(cube, ray, {1 / d.x, 1 / d.y, 1 / d.z}) < infinity ? 1 : 0);
        }
        double p = 2 / std::numbers::pi;
        check_mean(met, p, p * (1 - p), 0.005);
    }

    TEST_CASE("truth: the box test takes rays in the plane of a side") {
        ch05::Box box;
        box.add(Vec3{0, 0, 0}), box.add(Vec3{1, 1, 1});
        auto hit = [&](Vec3 o, Vec3 d) {
            return enter(box, {o, d}, {1 / d.x, 1 / d.y, 1 / d.z}) < infinity;
        };
        for (float zero : {0.0f, -0.0f}) {
            CHECK(hit({0, 0.5f, -1}, {zero, zero, 1}));
            CHECK(hit({1, 0.5f, -1}, {zero, zero, 1}));
            CHECK(hit({0, 0, -1}, {zero, zero, 1}));
            CHECK(hit({1, 1, -1}, {zero, zero, 1}));
            CHECK(hit({1, 0, -1}, {zero, zero, 1}));
            CHECK(hit({0.5f, 0.5f, 0.5f}, {zero, zero, 1}));
            CHECK_FALSE(hit({1.0001f, 0.5f, -1}, {zero, zero, 1}));
            CHECK_FALSE(hit({-0.0001f, 0.5f, -1}, {zero, zero, 1}));
        }
    }

    TEST_CASE("failure: a thousand equal triangles still end in a tree") {
        Scene scene;
        Geometry& g = scene.geometry;
        g.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
        g.triangles.assign(1000, {{0, 1, 2}, 0});
        for (const ch05::Finder& finder : all_finders(scene)) {
            ch05::Work work;
            PrimHit hit = find(finder, g, {{0.2f, 0.2f, 1}, {0, 0, -1}}, work);
            CHECK(hit.prim == 0);  // the lowest number among equals
            CHECK(hit.t == 1);
        }
        CHECK(ch05::build(g, ch05::split_sah).nodes.size() < 1000);
    }

    TEST_CASE("failure: NaN triangles are never hit, and hide nothing") {
        Scene scene = clutter(100), broken = clutter(100);
        broken.geometry.positions[30] = {std::nanf(""), 0, 0};
        scene.geometry.positions[30] = scene.geometry.positions[31];  // flat: never hit either
        scene.geometry.positions[32] = scene.geometry.positions[31];
        std::vector<ch05::Finder> finders = all_finders(broken);
        for (uint32_t i = 0; i < 2000; i++) {
            PrimHit truth = linear_scan(scene.geometry, ray_number(i));
            for (const ch05::Finder& finder : finders) {
                ch05::Work work;
                CHECK(find(finder, broken.geometry, ray_number(i), work).prim == truth.prim);
            }
        }
    }

    TEST_CASE("failure: an empty scene is missed") {
        Scene scene;
        for (const ch05::Finder& finder : all_finders(scene)) {
            ch05::Work work;
            CHECK(find(finder, scene.geometry, ray_number(1), work).prim == PrimHit::none);
        }
    }
}

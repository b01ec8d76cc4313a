// Chapter 06: every step finds the same hits, with less and less work.
#include <doctest/doctest.h>

#include "chapters/06_bvh/estimator.h"
#include "common/path/sampler.h"
#include "tests/support/gates.h"
#include "tests/support/meshes.h"

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

std::vector<ch06::Finder> all_finders(const Scene& scene) {
    std::vector<ch06::Finder> finders;
    for (size_t step = 0; step < ch06::step_names.size(); step++) {
        finders.push_back(make_finder(scene, static_cast<ch06::Step>(step)));
    }
    return finders;
}

/// All steps find the very bits of the linear scan, which are returned.
PrimHit check_finders(const std::vector<ch06::Finder>& finders, const Geometry& g, const Ray& ray) {
    PrimHit truth = linear_scan(g, ray);
    for (const ch06::Finder& finder : finders) {
        CAPTURE(ch06::step_names[static_cast<size_t>(finder.step)]);
        ch06::Work work;
        PrimHit hit = find(finder, g, ray, work);
        CHECK(hit.prim == truth.prim);
        CHECK(hit.t == truth.t);
        CHECK(hit.b1 == truth.b1);
        CHECK(hit.b2 == truth.b2);
    }
    return truth;
}

}  // namespace

TEST_SUITE("ch06 bvh") {
    TEST_CASE("brute: every step finds what the linear scan finds") {
        Scene scene = clutter(500);
        std::vector<ch06::Finder> finders = all_finders(scene);
        int hits = 0;
        for (uint32_t i = 0; i < 20000; i++) {
            PrimHit hit = check_finders(finders, scene.geometry, ray_number(i));
            hits += hit.prim != PrimHit::none;
        }
        CHECK(hits > 5000);
        CHECK(hits < 19000);
    }

    TEST_CASE("brute: no step loses a ray at the edges and corners of a closed mesh") {
        Scene scene;
        scene.geometry = closed_mesh(2);
        const Geometry& g = scene.geometry;
        std::vector<ch06::Finder> finders = all_finders(scene);
        Sampler sampler(SamplerType::independent, 8, 1);
        for (uint32_t i = 0; i < 10000; i++) {
            sampler.start(i, 0);
            const Triangle& t = g.triangles[i % g.triangles.size()];
            Vec3 a = g.positions[t.v[0]], b = g.positions[t.v[1]];
            Vec3 from = 0.2f * random_point(sampler);
            Vec3 at = i % 4 == 0 ? a : a + sampler.u1() * (b - a);
            CHECK(check_finders(finders, g, {from, at - from}).prim != PrimHit::none);
        }
    }

    TEST_CASE("variance: each step does less work than the one before") {
        Scene scene = clutter(5000);
        std::vector<ch06::Work> work;
        for (const ch06::Finder& finder : all_finders(scene)) {
            ch06::Work& sum = work.emplace_back();
            for (uint32_t i = 0; i < 1000; i++) find(finder, scene.geometry, ray_number(i), sum);
        }
        auto tests = [&](size_t step) {
            return static_cast<double>(work[step].boxes + work[step].prims);
        };
        const double most[] = {0.1, 0.8, 0.35, 0.9};  // of the step before
        for (size_t step = 1; step < 5; step++)
            CHECK(tests(step) < most[step - 1] * tests(step - 1));
        // It takes the largest child apart; with any other one, half as many and more are left.
        CHECK(static_cast<double>(work[4].nodes) < 0.47 * static_cast<double>(work[3].nodes));
    }

    TEST_CASE("truth: the SAH cost of a root parted into two cubes is 1 + 12/10") {
        ch06::Hierarchy h;
        Box root, left, right;
        left.add(Vec3{0, 0, 0}), left.add(Vec3{1, 1, 1});
        right.add(Vec3{1, 0, 0}), right.add(Vec3{2, 1, 1});
        root.add(left), root.add(right);
        h.nodes = {{root, 2, 0}, {left, 0, 1}, {right, 1, 1}};
        CHECK(sah_cost(h) == nearly(1 + 1.2, 1e-5));
    }

    TEST_CASE("truth: the box test takes rays in the plane of a side") {
        Box box;
        box.add(Vec3{0, 0, 0}), box.add(Vec3{1, 1, 1});
        // A ray that starts at (a, b, c) and goes along +z, with the axes turned by `turns`.
        auto hit = [&](float a, float b, float c, float zero, int turns) {
            Vec3 o, d;
            o[turns] = a, o[(turns + 1) % 3] = b, o[(turns + 2) % 3] = c;
            d[turns] = d[(turns + 1) % 3] = zero, d[(turns + 2) % 3] = 1;
            return ch06::enter(box, {o, d}, {1 / d.x, 1 / d.y, 1 / d.z}) < infinity;
        };
        for (int turns = 0; turns < 3; turns++) {
            for (float zero : {0.0f, -0.0f}) {
                for (float side : {0.0f, 1.0f}) {
                    CHECK(hit(side, 0.5f, -1, zero, turns));
                    CHECK(hit(0.5f, side, -1, zero, turns));
                    CHECK(hit(side, side, -1, zero, turns));
                }
                CHECK(hit(0.5f, 0.5f, 0.5f, zero, turns));
                CHECK_FALSE(hit(1.0001f, 0.5f, -1, zero, turns));
                CHECK_FALSE(hit(0.5f, -0.0001f, -1, zero, turns));
                CHECK_FALSE(hit(0.5f, 0.5f, 1.0001f, zero, turns));
            }
        }
    }

    TEST_CASE("failure: a thousand equal triangles still end in a tree") {
        Scene scene;
        Geometry& g = scene.geometry;
        g.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
        g.triangles.assign(1000, {{0, 1, 2}, 0});
        PrimHit hit = check_finders(all_finders(scene), g, {{0.2f, 0.2f, 1}, {0, 0, -1}});
        CHECK(hit.prim == 0);  // the lowest number among equals
        CHECK(ch06::build(g, ch06::split_sah).nodes.size() < 1000);
    }
}

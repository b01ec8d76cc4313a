// The smoothed normal of a mesh, for those who see a point from another side than its ray.
#include "common/scene/smooth_normal.h"

#include <doctest/doctest.h>

#include "tests/support/scenes.h"

TEST_SUITE("smoothed normal") {
    TEST_CASE(
        "identity: a point seen at a grazing angle has the smoothed normal that it has head-on") {
        Scene scene = world_of(
            "LightSource \"infinite\" Shape \"trianglemesh\" \"integer indices\" [0 1 2] "
            "\"point3 P\" [-1 -1 3  1.5 -1 2.5  0 1 3.5] \"normal N\" [-1 -.2 -1  1.2 -.3 -1  .1 "
            "1.1 -1]");
        Sampler random = random_numbers(2);
        int replaced = 0;
        for (int i = 0; i < 2000; i++) {
            Vec2 u = random.u2();
            Vec3 p = Vec3{-1, -1, 3} + u.x * (1 - u.y) * Vec3{2.5f, 0, -0.5f} +
                     0.9f * u.y * Vec3{1, 2, 0.5f};
            Vec3 n = scene.geometry.facet_normals[0];
            std::optional<Hit> on = intersect(scene, {p + n, -n});
            Vec3 d = normalize(uniform_direction(random.u2()) - 0.1f * n);
            std::optional<Hit> graze = intersect(scene, {p - d, d});
            if (!on || !graze || on->n == on->ng || dot(on->ng, graze->ng) < 0) continue;
            replaced += graze->n == graze->ng;
            CHECK(length(smooth_normal(scene, *on) - on->n) < 1e-5f);
            CHECK(length(smooth_normal(scene, *graze) - on->n) < 1e-4f);
        }
        CHECK(replaced > 50);
    }
}

// Chapters 21 and 22: every strategy, its weight, and all of them together.
#include <doctest/doctest.h>

#include "chapters/15_mis_ris/estimator.h"
#include "chapters/21_bidirectional/estimator.h"
#include "chapters/22_fast_bidirectional/estimator.h"
#include "tests/support/light_paths.h"

namespace {

Method by_15(const Scene& scene) { return method_of<ch15::trace>(ch15::prepare(scene)); }
Method by_21(const Scene& scene) { return method_of<ch21::trace>(endpoints_of(scene)); }
Method by_22(const Scene& scene) { return method_of<ch22::trace>(ch22::prepare(scene)); }
}  // namespace

TEST_SUITE("ch21 weights") {
    TEST_CASE("truth: vertices that touch have a weight, of 0, and not one that is no number") {
        Scene scene = scene_from("scenes/cornell.pbrt", 32, 7);
        Endpoints endpoints = endpoints_of(scene);
        std::optional<Hit> floor = intersect(scene, {{278, 273, 250}, {0, -1, 0}});
        REQUIRE(floor);
        ch21::Path path(4);
        path[0].x.p = {278, 548, 280}, path[0].x.ng = {0, -1, 0}, path[0].pdf = 1e-4f;
        path[1].x = path[2].x = *floor;
        path[3].x.p = endpoints.camera.view.o;
        for (size_t s = 0; s < 4; s++) CHECK(ch21::mis_weight(scene, endpoints, path, s) == 0);
    }
}

TEST_SUITE("ch21 bidirectional") {
    TEST_CASE("variance: a lamp in a shade: a tenth of the error of chapter 15" * doctest::skip()) {
        Scene scene = scene_from("scenes/lamp.pbrt", 32, 8);
        auto error_of = [&](const Method& method) {
            return blocks_of(scene, method, 16, 16, 4).relative_variance();
        };
        double tenth = error_of(by_15(scene)) / 10;
        CHECK(error_of(by_21(scene)) < tenth);
        CHECK(error_of(by_22(scene)) < tenth);
    }

    TEST_CASE("failure: a point light behind glass, seen through glass: no strategy" *
              doctest::skip()) {
        // LS+DS+E has one strategy, by chance; of a point light, none.
        Scene scene = scene_from("scenes/cornell-spheres.pbrt", 16, 8);
        Measured lamp =
            census_of(scene, by_22(scene), 400000, 1, {"LS+DS+E"}).measured("all LS+DS+E");
        CHECK(lamp.mean > 5 * lamp.se);
        Scene point = world_of(
            "LightSource \"point\" \"point3 from\" [0 2 0]\nAttributeBegin Translate 0 -1 0 Scale "
            "9 1 9 " +
            square(0, true) + "AttributeEnd Material \"dielectric\" Shape \"sphere\"\n");
        point.max_depth = 8;
        for (const auto& by : {by_21, by_22}) {
            Census census = census_of(point, by(point), 100000, 1, {"LS+DS+E", "LS+DE"});
            CHECK(census.measured("all LS+DS+E").mean == 0);
            CHECK(census.measured("all LS+DE").mean > 0);
        }
    }
}

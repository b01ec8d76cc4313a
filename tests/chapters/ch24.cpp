// Chapter 24: photons whose radius shrinks from pass to pass.
#include <doctest/doctest.h>

#include "chapters/15_mis_ris/estimator.h"
#include "chapters/23_photon_mapping/estimator.h"
// In this order: names of a lower chapter must not be found through a higher one.
#include "chapters/24_progressive_photons/estimator.h"
#include "tests/support/light_paths.h"

namespace {

Method by_24(const Scene& scene, const PhotonSettings& settings) {
    return ch24::photon_passes(scene, settings);
}

}  // namespace

TEST_SUITE("ch24 radius") {
    TEST_CASE("truth: radii shrink as (i + alpha) / (i + 1)") {
        auto radius = [](uint32_t pass) { return double{ch24::radius_of(3, pass)} / 3; };
        CHECK(radius(0) == 1);
        for (uint32_t pass = 1; pass < 1000; pass++) {
            double ratio = radius(pass) / radius(pass - 1);
            CHECK(ratio * ratio == nearly((pass + 2.0 / 3) / (pass + 1.0), 1e-5));
        }
        double slope = std::log10(radius(100000) / radius(10000));
        CHECK(slope == nearly(-1.0 / 6, 1e-3));
    }
}

TEST_SUITE("ch24 progressive photons") {
    TEST_CASE("identity: each pass is one of chapter 23 with that pass's radius") {
        // A lamp over rough metal, and a mirror above that shows it from there once more.
        Scene mirrored = world_of(
            "Material \"conductor\" \"float roughness\" 0.4 AttributeBegin Translate 0 -1 0 "
            "Scale 9 1 9 " +
                square(0, true) +
                "AttributeEnd AttributeBegin Material "
                "\"conductor\" Translate 0 2 0 Scale 9 1 9 " +
                square(0, false) +
                "AttributeEnd AreaLightSource \"diffuse\" Translate 0 1 0 Shape \"sphere\" "
                "\"float radius\" 0.5",
            12);
        mirrored.max_depth = 5;
        for (const Scene& scene :
             {scene_from("scenes/cornell-spheres.pbrt", 12, 5),
              scene_from("scenes/veach-mis.pbrt", 12, 5), mirrored, leaning_wall()}) {
            for (bool final_gathering : {false, true}) {
                PhotonSettings of_24{.light_paths = 20000, .final_gathering = final_gathering};
                float first = by_24(scene, of_24).first_radius;
                for (uint32_t pass : {20u, 0u, 1u}) {
                    ch23::PhotonSettings of_23{.light_paths = 20000,
                                               .final_gathering = final_gathering,
                                               .radius = ch24::radius_of(first, pass)};
                    auto film_of_pass = [&](Method method) {
                        method.prepare(pass, 2, [] { return false; });
                        method.prepare = nullptr;
                        return film_of(scene, method, 1, pass).film;
                    };
                    Film expected = film_of_pass(ch23::photon_passes(scene, of_23));
                    CHECK(film_of_pass(by_24(scene, of_24)).image().pixels ==
                          expected.image().pixels);
                    CHECK(expected.mean() > 0);
                }
            }
        }
    }
}

TEST_SUITE("ch24 progressive photons slow") {
    TEST_CASE("truth: bias and noise together go to 0 as N^(-2/3)") {
        Scene scene = bulb_over_a_floor();
        Film exact = film_of(scene, method_of<ch15::trace>(ch15::prepare(scene)), 40000).film;
        auto error = [&](int spp) {
            RunningStats mse;
            for (uint32_t seed = 1; seed <= 24; seed++) {
                Method method = by_24(
                    scene,
                    {.seed = seed, .light_paths = 1000, .final_gathering = false, .radius = 0.4f});
                mse.add(mean_squared_error(film_of(scene, method, spp, seed).film, exact));
            }
            return mse.mean();
        };
        double first = error(32), last = error(2048);
        double slope = std::log(last / first) / std::log(64.0);
        CAPTURE(first);
        CAPTURE(last);
        CHECK(slope == nearly(-2.0 / 3, 0.12));
    }
}

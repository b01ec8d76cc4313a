// Chapters 20 to 25 in scenes with an image of the sky, a lens or shapes that move: what chapters
// 16 and 17 render, class by class.
#include <doctest/doctest.h>

#include "tests/traces/16.h"
#include "tests/traces/17.h"
#include "tests/traces/20.h"
#include "tests/traces/21.h"
#include "tests/traces/22.h"
#include "tests/traces/23.h"
#include "tests/traces/24.h"
#include "tests/traces/25.h"
#include "common/options/loading.h"
#include "tests/support/light_paths.h"

namespace {

Method by_16(const Scene& scene) { return method_of<ch16::trace>(ch16::prepare(scene)); }
Method by_17(const Scene& scene) { return method_of<ch17::trace>(ch17::prepare(scene)); }
Method by_20(const Scene& scene) { return method_of<ch20::trace_light>(ch20::endpoints_of(scene)); }
Method by_21(const Scene& scene) { return method_of<ch21::trace>(endpoints_of(scene)); }
Method by_22(const Scene& scene) { return method_of<ch22::trace>(ch22::prepare(scene)); }

/// An image of the sky, brighter to one side, with a sun.
SkyImage sunny_sky() {
    SkyImage sky;
    sky.map = SkyImage::Map::wide, sky.width = 32, sky.height = 16;
    sky.x = {1, 0, 0}, sky.y = {0, 0, -1}, sky.z = {0, 1, 0};
    for (size_t i = 0; i < 32 * 16; i++) {
        Vec3 d = direction_of(sky, sky.middle_of(i));
        float L = 0.3f + 0.2f * d.x;
        sky.pixels.push_back({L, L, 1.5f * L});
    }
    sky.pixels[sky.pixel_at(point_of(sky, normalize({-0.5f, 0.8f, -0.4f})))] = {40, 36, 30};
    return sky;
}
SkyImage sky_of_one_colour(Rgb L) {
    SkyImage sky;
    sky.width = sky.height = 8, sky.pixels.assign(64, L);
    return sky;
}

const std::string floor_and_balls =
    "AttributeBegin Material \"diffuse\" \"rgb reflectance\" [.6 .5 .4] Translate 0 -1 0 Scale 4 1 "
    "4 " +
    square(0, true) +
    "AttributeEnd AttributeBegin Material \"dielectric\" Translate -0.5 -0.3 0 Shape \"sphere\" "
    "\"float radius\" 0.5 AttributeEnd AttributeBegin Material \"conductor\" \"float roughness\" "
    "0.3 Translate 0.6 -0.5 0 Shape \"sphere\" \"float radius\" 0.5 AttributeEnd ";
const std::string lamp =
    "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [8 6 4] Material "
    "\"diffuse\" \"rgb reflectance\" [0 0 0] Translate 1 1.5 0 Scale .3 1 .3 " +
    square(0, false) + "AttributeEnd ";

/// Glass and metal on a floor under this image, with a lamp or without any other light.
Scene under(const SkyImage& sky, bool with_lamp, int size = 32) {
    Scene scene = world_of(floor_and_balls + (with_lamp ? lamp : "LightSource \"infinite\""), size);
    if (!with_lamp) scene.lights.clear(), scene.sky = {}, scene.sky_light = -1;
    scene.sky_image = sky;
    scene.camera.o = {0, 0.5f, -4};
    scene.max_depth = 5;
    return scene;
}

/// Means of blocks over seeds, by the passes of a chapter.
template <class MakePasses, class Settings>
BlockMeans blocks_of_passes(Scene scene, const MakePasses& passes, Settings settings, int spp,
                            int runs, const std::string& paths) {
    BlockMeans means{scene.width, 8};
    scene.spp = spp;
    RenderOptions options;
    options.threads = 2, options.quiet = true, options.paths = paths;
    for (int run = 0; run < runs; run++) {
        options.seed = settings.seed = static_cast<uint32_t>(run);
        means.add(render_film(scene, options, passes(scene, settings)).film.image());
    }
    return means;
}
void check_same(const BlockMeans& a, const BlockMeans& b, double bias, double relative_se) {
    double mean = b.whole.mean();
    double se = std::hypot(a.whole.standard_error(), b.whole.standard_error());
    CAPTURE(mean);
    CAPTURE(se);
    CHECK(std::abs(a.whole.mean() - mean) <= 5 * se + bias * mean);
    CHECK(se <= relative_se * mean);
}
/// Chapters 23, 24 and 25 against a truth, in these classes of path.
template <class AnyTrace>
void check_photons(const Scene& scene, const AnyTrace& truth,
                   const std::vector<std::string>& classes, float radius = 0.01f, int spp = 64) {
    float r = radius * scene.radius;
    for (const std::string& paths : classes) {
        CAPTURE(paths);
        BlockMeans expected = blocks_of(scene, truth, spp, 16, 8, paths);
        ch23::PhotonSettings settings{.light_paths = 20000, .radius = r};
        PhotonSettings later{.light_paths = 20000, .radius = r};
        auto check = [&](const BlockMeans& own) { check_same(own, expected, 0.01, 0.03); };
        check(blocks_of_passes(scene, passes_of<ch23::photon_passes, ch23::PhotonSettings>,
                               settings, 16, 16, paths));
        check(blocks_of_passes(scene, passes_of<ch24::photon_passes, PhotonSettings>, later, 16, 16,
                               paths));
        check(blocks_of_passes(scene, passes_of<ch25::merging_passes, PhotonSettings>, later, 16,
                               16, paths));
    }
}

}  // namespace

TEST_SUITE("every scene: an image of the sky") {
    TEST_CASE("truth: the image sends out its power: pi R^2 times the sum of L over the sphere") {
        for (bool with_lamp : {false, true}) {
            Scene scene = under(sunny_sky(), with_lamp);
            const SkyImage& sky = *scene.sky_image;
            double truth = 0, R = double{scene.radius};
            for (size_t i = 0; i < sky.pixels.size(); i++)
                truth += double{sky.pixels[i].g} *
                         double{solid_angle_per_area(sky, sky.middle_of(i))} * pi_exact * R * R /
                         static_cast<double>(sky.pixels.size());
            Endpoints endpoints = endpoints_of(scene);
            CHECK(endpoints.p_image == (with_lamp ? 0.5 : 1.0));
            RunningStats flux;
            Sampler random = random_numbers(1);
            for (int i = 0; i < 200000; i++) {
                double u = to_unit_double(random.u2());
                Vec2 u_y = random.u2();
                Emission e = sample_emission(scene, endpoints, u, u_y, random.u2());
                bool image = e.type == LightType::infinite;
                flux.add(image ? double{e.Le.g} / double{e.pmf * e.y.pdf * e.pdf_w} : 0);
            }
            // The sum by the middles of pixels is right to 1e-3.
            CHECK(std::abs(flux.mean() - truth) <= 5 * flux.standard_error() + 1e-3 * truth);
            CHECK(flux.standard_error() < 0.01 * truth);
        }
    }

    TEST_CASE("identity: a path from the eye meets the sky with the density of light paths") {
        for (bool with_lamp : {false, true}) {
            Scene scene = under(sunny_sky(), with_lamp);
            Endpoints endpoints = endpoints_of(scene);
            Sampler sampler = random_numbers(1);
            Recorder recorder;
            int compared = 0, others = 0;
            for (int i = 0; i < 2000; i++) {
                ch21::Path path = ch21::light_subpath(scene, endpoints, sampler, recorder);
                if (path[0].type != LightType::infinite) continue;
                Ray ray = {{0, 0, 0}, -1 * path[0].x.ng};
                ch21::Vertex v = ch21::vertex_at(scene, endpoints, {}, ray, {1, 1, 1});
                CHECK(v.type == LightType::infinite);
                compared++;
                // At the edge of a pixel, the direction may lie in the next one.
                if (v.Le.g == path[0].beta.g * path[0].pdf) continue;
                bool same = std::abs(v.pdf / path[0].pdf - 1) < 1e-3f &&
                            std::abs(v.Le.g / (path[0].beta.g * path[0].pdf) - 1) < 1e-3f;
                others += !same;
            }
            CHECK(compared > 800);
            CHECK(others <= 2);
        }
    }

    TEST_CASE("agreement: chapters 20 to 22 with chapter 17, by length and class" *
              doctest::skip()) {
        for (bool with_lamp : {false, true}) {
            CAPTURE(with_lamp);
            Scene scene = under(sunny_sky(), with_lamp);
            CHECK(check_classes(scene, by_17(scene), scene, by_20(scene), 400000, 1,
                                shown_by_light) >= 6);
            CHECK(check_classes(scene, by_17(scene), scene, by_21(scene), 100000) >= 10);
            CHECK(check_classes(scene, by_17(scene), scene, by_22(scene), 200000) >= 10);
        }
    }

    TEST_CASE("agreement: caustics of the sun with chapter 20, which finds them at once" *
              doctest::skip()) {
        Scene scene = under(sunny_sky(), true);
        for (const auto& by : {by_21, by_22})
            CHECK(check_classes(scene, by_20(scene), scene, by(scene), 200000, 1, shown_by_light) >=
                  8);
    }

    TEST_CASE("truth: a sky without an image is added to the image") {
        Scene scene = world_of(floor_and_balls + "LightSource \"infinite\" \"rgb L\" [1 2 3]");
        scene.sky_image = sky_of_one_colour({1, 1, 1});
        for (int times = 0; times < 2; times++) {
            prepare(scene, 1);
            CHECK(sky_towards(scene, {0, 1, 0}).r == 2);
            CHECK(sky_towards(scene, {0, 1, 0}).b == 4);
            CHECK(is_black(scene.sky));
        }
    }
}

TEST_SUITE("every scene: a lens") {
    /// Glass and metal under a lamp, out of focus.
    Scene through_a_lens() {
        Scene scene = world_of(floor_and_balls + lamp + "LightSource \"infinite\"");
        scene.camera.o = {0, 0.5f, -4};
        scene.camera.lens_radius = 0.3f, scene.camera.focal_distance = 3;
        scene.max_depth = 5;
        return scene;
    }

    TEST_CASE("agreement: chapters 21 and 22 with chapter 16, by length and class" *
              doctest::skip()) {
        for (const Scene& scene : {through_a_lens(), scene_from("scenes/bokeh.pbrt", 32, 4)}) {
            CHECK(check_classes(scene, by_16(scene), scene, by_21(scene), 200000) >= 6);
            CHECK(check_classes(scene, by_16(scene), scene, by_22(scene), 200000) >= 6);
        }
    }

    TEST_CASE("identity: by the weights alone, chapter 22 gives each way its weight in 21") {
        // Behind a lens and under an image of the sky.
        for (const Scene& scene : {through_a_lens(), under(sunny_sky(), true)}) {
            auto fast = method_of<ch22::trace>(ch22::prepare(scene, 0, false));
            PathCensus a = census_of(scene, by_21(scene), 20000, 1);
            PathCensus b = census_of(scene, fast, 20000, 1);
            CHECK(a.all.measured(a.paths).mean ==
                  doctest::Approx(b.all.measured(b.paths).mean).epsilon(1e-4).scale(0));
            for (const auto& [name, part] : a.by_class)
                CHECK(part.measured(a.paths).mean ==
                      doctest::Approx(b.by_class[name].measured(b.paths).mean)
                          .epsilon(1e-3)
                          .scale(0));
        }
    }
}

TEST_SUITE("every scene: photons slow") {
    TEST_CASE("agreement: chapters 23 to 25 with chapter 17 under an image of the sky") {
        Scene scene = under(sunny_sky(), true);
        check_photons(scene, by_17(scene), {"LE", "LDE", "LDD+E"});
        check_photons(scene, by_22(scene), {"LD(D|S)*E"});
        check_photons(scene, by_20(scene), {"LS+DE"}, 0.04f, 256);
    }

    TEST_CASE("agreement: chapters 23 to 25 with chapter 16 behind a lens") {
        Scene scene = scene_from("scenes/bokeh.pbrt", 32, 4);
        check_photons(scene, by_16(scene), {"LDE", "LD(D|S)*E"});
    }
}

TEST_SUITE("every scene: shapes that move") {
    TEST_CASE("agreement: chapters 20 to 22 with chapter 16, by length and class" *
              doctest::skip()) {
        Scene scene = scene_from("scenes/moving-ball.pbrt", 32, 4);
        CHECK(check_classes(scene, by_16(scene), scene, by_20(scene), 400000, 1, shown_by_light) >=
              6);
        CHECK(check_classes(scene, by_16(scene), scene, by_21(scene), 100000) >= 6);
        CHECK(check_classes(scene, by_16(scene), scene, by_22(scene), 100000) >= 6);
        for (const auto& trace : {by_20(scene), by_21(scene), by_22(scene)}) {
            BlockMeans a = blocks_of(scene, by_16(scene), 16, 24, 8, shown_by_light);
            BlockMeans b = blocks_of(scene, trace, 16, 24, 8, shown_by_light);
            CHECK(hold_against(a, b).agrees());
        }
    }
}

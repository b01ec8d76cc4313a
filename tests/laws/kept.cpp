// What common/ keeps of a chapter, for later ones, beside the chapter itself.
#include <doctest/doctest.h>

#include "chapters/17_sky_image/estimator.h"
#include "chapters/18_dispersion/estimator.h"
#include "chapters/20_light_tracing/estimator.h"
#include "chapters/23_photon_mapping/estimator.h"
#include "common/path/dispersion.h"
#include "common/path/image_light.h"
#include "common/path/photons.h"
#include "tests/known/scenes.h"
#include "tests/support/estimators.h"

TEST_SUITE("law: kept chapters") {
    TEST_CASE("identity: an image of the sky is sampled by common/ as by chapter 17") {
        Sampler random = random_numbers(17);
        for (SkyImage::Map map : {SkyImage::Map::square, SkyImage::Map::wide})
            for (bool compensate : {false, true}) {
                SkyImage sky;
                sky.map = map, sky.height = 9, sky.width = map == SkyImage::Map::square ? 9 : 18;
                sky.x = {1, 0, 0}, sky.y = {0, 0, -1}, sky.z = {0, 1, 0};
                for (int i = 0; i < sky.width * sky.height; i++)
                    sky.pixels.push_back({random.u1(), random.u1(), random.u1()});
                std::vector<double> cdf = ch17::image_cdf(sky, compensate);
                CHECK(sky_light::image_cdf(sky, compensate) == cdf);
                for (int i = 0; i < 1000; i++) {
                    double u = to_unit_double(random.u2());
                    Vec2 u2 = random.u2();
                    LightSample a = ch17::sample_image(sky, cdf, u, u2),
                                b = sky_light::sample_image(sky, cdf, u, u2);
                    CHECK(a.wi == b.wi);
                    CHECK(a.Le == b.Le);
                    CHECK(a.pdf_w == b.pdf_w);
                }
            }
    }

    TEST_CASE("identity: a wavelength is sampled by common/ as by chapter 18") {
        std::vector<Rgb> white = shares_of_white();
        for (int i = 0; i < 1000; i++) {
            float u = (static_cast<float>(i) + 0.5f) / 1000;
            auto a = ch18::sample_wavelength(white, u);
            auto b = dispersion::sample_wavelength(white, u);
            CHECK(a.micrometres == b.micrometres);
            CHECK(a.weight == b.weight);
        }
    }

    TEST_CASE("identity: light scatters, and meets the camera, by common/ as by chapter 20") {
        for (const char* name : {"leaning", "away"}) {
            Scene scene = scene_of(known_scene(name).text);
            auto camera = ch20::pinhole_of(scene);
            Pinhole kept = ::pinhole_of(scene);
            Sampler random = random_numbers(20);
            int lit = 0;
            for (int i = 0; i < 2000; i++) {
                Vec2 u = random.u2(), u2 = random.u2();
                Vec3 from = {0, 1.5f, 0}, to = {u.x - 0.4f, 0, 0.4f * u.y - 0.2f};
                Hit x = *intersect(scene, {from, normalize(to - from)});
                Vec3 wi = normalize(from - to), wo = uniform_direction(random.u2());
                CHECK(ch20::adjoint_bsdf(scene, x, wi, wo) == ::adjoint_bsdf(scene, x, wi, wo));
                Splat a = ch20::connect_to_camera(scene, camera, x, wi, {1, 1, 1}),
                      b = ::connect_to_camera(scene, kept, x, wi, {1, 1, 1});
                CHECK((a.pixel == b.pixel && a.L == b.L));
                lit += !is_black(a.L);
                BsdfSample s = ch20::sample_light_bsdf(scene, x, wi, u.x, u2),
                           t = ::sample_light_bsdf(scene, x, wi, u.x, u2);
                CHECK((s.wi == t.wi && s.f == t.f && s.pdf_w == t.pdf_w));
            }
            CHECK(lit > 500);
        }
    }

    TEST_CASE("identity: the first radius of common/ is that of chapter 23") {
        for (const char* name : {"mirror-beside", "three"})
            for (int pixels : {16, 200}) {
                Scene scene = scene_of(known_scene(name).text);
                scene.width = scene.height = pixels;
                Endpoints endpoints = endpoints_of(scene);
                float radius = choose_radius(scene, endpoints, {.light_paths = 3000});
                CHECK(radius > 0);
                CHECK(radius == ch23::choose_radius(scene, endpoints, {.light_paths = 3000}));
            }
    }
}

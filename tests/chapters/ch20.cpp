// Chapter 20: what a path from a light brings to the camera.
#include <doctest/doctest.h>

#include "chapters/15_mis_ris/estimator.h"
#include "chapters/20_light_tracing/estimator.h"
#include "common/results/warnings.h"
#include "tests/support/known_lights.h"
#include "tests/support/light_paths.h"

namespace {

Method by_fifteen(const Scene& scene) { return method_of<ch15::trace>(ch15::prepare(scene)); }
Method by_twenty(const Scene& scene) {
    return method_of<ch20::trace_light>(ch20::endpoints_of(scene));
}

/// A grey floor of side 2 `half` below a pinhole that looks straight down from height 1.
Scene floor_below(const std::string& light, double half, double fov = 90, int width = 8,
                  int height = 8) {
    std::string side = std::to_string(half);
    Scene scene = scene_of("LookAt 0 1 0  0 0 0  0 0 1\nCamera \"perspective\" \"float fov\" " +
                           std::to_string(fov) + "\nFilm \"rgb\" \"integer xresolution\" " +
                           std::to_string(width) + " \"integer yresolution\" " +
                           std::to_string(height) + "\nWorldBegin\nAttributeBegin " +
                           "Material \"diffuse\" \"rgb reflectance\" [.5 .5 .5] Scale " + side +
                           " 1 " + side + " " + square(0, true) + "AttributeEnd\n" + light);
    scene.max_depth = 1;
    return scene;
}
const std::string sun = "LightSource \"distant\" \"point3 from\" [0 1 0] \"point3 to\" [0 0 0]\n";

/// What all paths bring to all pixels: one number for each path, whose mean is that of the picture.
PathSum totals(const Scene& scene, int paths, uint32_t seed = 1, const std::string& filter = "") {
    return census_of(scene, by_twenty(scene), paths, seed, filter).all;
}
void check_picture_mean(const Scene& scene, double truth, int paths, double relative_se) {
    Measured m = totals(scene, paths).measured(paths);
    CAPTURE(truth);
    CHECK(std::abs(m.mean - truth) < 5 * m.se + 1e-5 * truth);
    CHECK(m.se < relative_se * truth);
}

/// Chapter 15 and 17 by class of path; `least`: so many classes must be there.
struct Agreement {
    std::string name;
    int paths, least;
};
void check_classes_of(const std::vector<Agreement>& cases) {
    for (const auto& c : cases) {
        CAPTURE(c.name);
        Scene scene = scene_from("scenes/" + c.name + ".pbrt", 32, 8);
        CHECK(check_classes(scene, by_fifteen(scene), scene, by_twenty(scene), c.paths, 1,
                            shown_by_light) >= c.least);
    }
}

}  // namespace

TEST_SUITE("ch20 camera") {
    TEST_CASE("truth: a lit floor is as bright as it should be") {
        // Irradiance 1: a point of the floor, all alike likely, stands for the flux of all 4 m^2.
        // What it brings is the same wherever the camera sees it, even in the corners.
        Scene scene = floor_below(sun, 1);
        ch20::Pinhole camera = ch20::pinhole_of(scene);
        Sampler random = random_numbers(1);
        int seen = 0;
        for (int i = 0; i < 10000; i++) {
            float x = 2 * random.u1() - 1, z = 2 * random.u1() - 1;
            Hit floor = *intersect(scene, {{x, 5, z}, {0, -1, 0}});
            Splat splat = ch20::connect_to_camera(scene, camera, floor, {0, 1, 0}, {4, 4, 4});
            if (is_black(splat.L)) continue;  // in the outermost pixels, by rounding
            seen++;
            CHECK(splat.L.g == doctest::Approx(0.1591549430919).epsilon(1e-5).scale(0));
            int px = static_cast<int>(splat.pixel % 8);
            CHECK(std::abs(static_cast<double>(std::abs(x)) * 4 - std::abs(px + 0.5 - 4)) < 0.51);
        }
        CHECK(seen > 9990);
        check_picture_mean(floor_below(sun, 3), 0.1591549430919, 200000, 0.01);
    }

    TEST_CASE("identity: a light point is in the pixel whose rays meet it, with any camera") {
        Scene scene = scene_from("scenes/cornell.pbrt", 32, 1);
        for (int k = 0; k < 3; k++) {
            if (k == 1) scene.width = 77, scene.camera.screen_window = {{-0.3f, 0.9f, -0.2f, 0.4f}};
            if (k == 2) scene.camera.right = 2 * scene.camera.right + scene.camera.up;  // skew
            ch20::Pinhole camera = ch20::pinhole_of(scene);
            Sampler random = random_numbers(1);
            for (int i = 0; i < 1000; i++) {
                Vec2 u = random.u2();
                Vec2 film = {u.x * static_cast<float>(scene.width),
                             u.y * static_cast<float>(scene.height)};
                Vec3 d = camera_ray(camera.view, film).d;
                auto importance = ch20::camera_importance(camera, (1 + 100 * random.u1()) * d);
                size_t x = static_cast<size_t>(film.x), y = static_cast<size_t>(film.y);
                bool inside =
                    film.x - std::floor(film.x) > 1e-3f && film.y - std::floor(film.y) > 1e-3f;
                if (!inside) continue;
                REQUIRE(importance.has_value());
                CHECK(importance->pixel == y * static_cast<size_t>(scene.width) + x);
                CHECK(!ch20::camera_importance(camera, -1 * d));
            }
        }
    }

    TEST_CASE("truth: all of the camera's importance is 1") {
        // Mean over directions of 4 pi We cos.
        for (int fov : {20, 90, 140}) {
            Scene scene = floor_below(sun, 1, fov, 30, 20);
            ch20::Pinhole camera = ch20::pinhole_of(scene);
            RunningStats s;
            Sampler random = random_numbers(1);
            for (int i = 0; i < 1000000; i++) {
                auto importance = ch20::camera_importance(camera, uniform_direction(random.u2()));
                s.add(importance ? 4 * pi_exact * static_cast<double>(importance->We_cos) : 0);
            }
            check_bounded(s, 1, 0.01);
        }
    }

    TEST_CASE("truth: a lamp that faces the camera: its area on the film times its radiance") {
        Scene scene = world_of(shining + "Translate 0 0 -2 Rotate 180 0 1 0 Shape \"disk\" " +
                               "\"float radius\" 0.5\n");
        // The film at distance 1 is 2 tan 20 wide and high.
        double film = std::pow(2 * std::tan(pi_exact / 9), 2);
        check_picture_mean(scene, 0.1963495408494 / film, 100000, 0.005);
    }
}

TEST_SUITE("ch20 light tracing") {
    TEST_CASE("identity: each light sends out its power") {
        Scene scene = world_of(
            square(0, true) + "LightSource \"point\" \"point3 from\" [1 2 0] \"rgb I\" [1 2 3]\n" +
            "LightSource \"distant\" \"point3 to\" [1 -2 3] LightSource \"infinite\"\n" +
            "AttributeBegin " + shining + "Translate 1 1 0 Shape \"sphere\" AttributeEnd " +
            "AttributeBegin " + shining + "Rotate 70 1 2 3 Shape \"disk\" AttributeEnd " +
            "AreaLightSource \"diffuse\" \"bool twosided\" true Translate 0 3 0 " +
            square(0, false));
        ch20::Endpoints endpoints = ch20::endpoints_of(scene);
        Sampler random = random_numbers(1);
        double share = 0, backs = 0, n = 0;
        for (int k = 0; k < 20000; k++) {
            double u = to_unit_double(random.u2());
            size_t i = pick_light(endpoints.lights, u);
            Vec2 u_y = random.u2();
            ch20::Emission e = ch20::sample_emission(scene, endpoints, u, u_y, random.u2());
            REQUIRE(length(e.d) == doctest::Approx(1).epsilon(1e-5).scale(0));
            bool point = e.type == LightType::point;
            float cos_y = point ? 1 : dot(e.d, e.y.n);
            REQUIRE(cos_y >= 0);
            if (cos_y < 1e-4f) continue;
            CHECK(e.pmf == pmf_light(endpoints.lights, i));
            double flux = static_cast<double>(average(e.Le) * cos_y / (e.y.pdf * e.pdf_w));
            CHECK(flux == doctest::Approx(light_power(scene, i)).epsilon(1e-4).scale(0));
            if (!scene.lights[i].two_sided) continue;
            n++, backs += e.y.n.y > 0, share += e.d.y > 0;
        }
        CHECK(n > 500);
        CHECK(std::abs(backs / n - 0.5) < 5 * 0.5 / std::sqrt(n));
        CHECK(share == backs);
    }

    TEST_CASE("density: rays of the sky and the sun fill the disk of the scene evenly") {
        Scene scene = world_of("Translate 5 6 7 " + square(0, true) + "LightSource \"infinite\"");
        ch20::Endpoints endpoints = ch20::endpoints_of(scene);
        Sampler random = random_numbers(1);
        std::vector<double> rings(10), octants(8);
        for (int i = 0; i < 100000; i++) {
            Vec2 u_y = random.u2();
            ch20::Emission e = ch20::sample_emission(scene, endpoints, 0.5, u_y, random.u2());
            Vec3 to = scene.centre - e.y.p;
            float r2 = (dot(to, to) - dot(to, e.d) * dot(to, e.d)) / scene.radius / scene.radius;
            rings[std::min<size_t>(9, static_cast<size_t>(10 * r2))]++;
            octants[static_cast<size_t>((e.d.x > 0) + 2 * (e.d.y > 0) + 4 * (e.d.z > 0))]++;
        }
        CHECK(chi_square_tail(chi_square(rings), 9) > 1e-6);
        CHECK(chi_square_tail(chi_square(octants), 7) > 1e-6);
    }

    TEST_CASE("truth: irradiance of all lights" * doctest::skip()) {
        // The picture shows a square of 10 cm around the origin.
        auto all = lights_of_known_irradiance;
        all.insert(all.end(), lights_without_size.begin(), lights_without_size.end());
        for (const auto& [light, E] : all) {
            if (E < 0.1) continue;  // too few of its paths come here
            Scene scene = floor_below(light, 0.1);
            scene.camera.o = {0, 0.05f, 0};
            constexpr int paths = 3000000;
            double truth = 0.5 * E / pi_exact;
            Measured m = totals(scene, paths).measured(paths);
            CHECK(std::abs(m.mean - truth) < 5 * m.se + 0.003 * truth);
            CHECK(m.se < 0.06 * truth);
        }
    }

    TEST_CASE("furnace: inside a sphere that emits 1 and reflects the albedo: 1 / (1 - albedo)" *
              doctest::skip()) {
        for (double albedo : {0.0, 0.5, 0.8}) {
            std::string a = std::to_string(albedo);
            Scene scene = scene_of(
                "LookAt 0 0 0  0 0 1  0 1 0\nCamera \"perspective\" \"float fov\" 60\n"
                "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\nWorldBegin\n"
                "ReverseOrientation AreaLightSource \"diffuse\" \"rgb L\" [1 1 1]\n"
                "Material \"diffuse\" \"rgb reflectance\" [" +
                a + " " + a + " " + a + "] Shape \"sphere\" \"float radius\" [1]\n");
            scene.max_depth = 1000;
            check_picture_mean(scene, 1 / (1 - albedo), 400000, 0.01);
        }
    }

    TEST_CASE("agreement: pictures, lengths and classes of paths with chapter 15" *
              doctest::skip()) {
        check_classes_of({{"cornell", 200000, 12},
                          {"cornell-spheres", 200000, 12},
                          {"two-lights", 200000, 8},
                          {"color-bleeding", 200000, 10},
                          {"caustic", 200000, 4},
                          {"furnace", 200000, 2}});
    }

    TEST_CASE("agreement: each block of the picture with chapter 15" * doctest::skip()) {
        for (std::string name : {"cornell", "cornell-spheres", "two-lights"}) {
            CAPTURE(name);
            Scene scene = scene_from("scenes/" + name + ".pbrt", 32, 5);
            BlockMeans a = blocks_of(scene, by_fifteen(scene), 16, 32, 8, shown_by_light);
            BlockMeans b = blocks_of(scene, by_twenty(scene), 16, 32, 8, shown_by_light);
            check_agreement(hold_against(a, b), 0.02);
        }
    }

    TEST_CASE("agreement: a light in glass" * doctest::skip()) {
        Scene scene = scene_from("scenes/light-in-glass.pbrt", 32, 8);
        CHECK(check_classes(scene, by_fifteen(scene), scene, by_twenty(scene), 1000000, 1,
                            shown_by_light) >= 6);
    }

    TEST_CASE("truth: flux through a pane of glass, from both sides" * doctest::skip()) {
        // A floor in the sun under a pane: (1 - R) / (1 + R) = 12 / 13 of it.
        auto check = [&](const std::string& glass, const char* classes, double share) {
            Scene scene = floor_below(sun +
                                          "AttributeBegin Material \"dielectric\" \"float eta\" "
                                          "[1.5] " +
                                          glass + "AttributeEnd\n",
                                      1);
            scene.camera.o = {0, 0.3f, 0};
            scene.max_depth = 50;
            Measured m = totals(scene, 1000000, 1, classes).measured(1000000);
            CHECK(std::abs(m.mean - share * 0.1591549430919) < 5 * m.se);
            CHECK(m.se < 0.01 * m.mean);
        };
        check(square(0.5f, true) + square(0.4f, false), "LS*DE", 12 / 13.0);
        // Flux is not squeezed where it enters glass, nor where it leaves it.
        check(square(0.5f, true), "LSDE", 0.96);
        check(square(0.5f, false), "LSDE", 0.96);
    }

    TEST_CASE("failure: mirrors seen directly are black, and a warning says so") {
        Scene mirror = light_before_mirror();
        Rendering r = film_of(mirror, by_twenty(mirror), 16);
        CHECK(r.film.mean() == 0);
        RenderOptions options;
        options.search = LightSearch::from_lights;
        std::vector<std::string> lines = warnings_of(mirror, options, r);
        REQUIRE(!lines.empty());
        CHECK(lines.back().find("mirror or glass: this part is black") != std::string::npos);
        Scene none = floor_without_lights();
        CHECK(film_of(none, by_twenty(none), 4).film.mean() == 0);
        Scene cornell = scene_from("scenes/cornell.pbrt", 16, 2);
        r = film_of(cornell, by_twenty(cornell), 16);
        CHECK(warnings_of(cornell, options, r).empty());
    }

    TEST_CASE("variance: a caustic: a hundredth of the relMSE of chapter 15, and less") {
        Scene scene = scene_from("scenes/caustic.pbrt", 32, 8);
        auto error_of = [&](const auto& trace) {
            BlockMeans m = blocks_of(scene, trace, 16, 16, 4, "LS+DE");
            double sum = 0;
            for (const RunningStats& s : m.blocks)
                sum += s.variance() / (s.mean() * s.mean() + 1e-4);
            return sum;
        };
        CHECK(error_of(by_twenty(scene)) < error_of(by_fifteen(scene)) / 100);
    }
}

TEST_SUITE("ch20 slow") {
    TEST_CASE("consistency: the reported error is the spread over seeds, with each sampler" *
              doctest::skip()) {
        Scene scene = scene_from("scenes/cornell.pbrt", 32, 4);
        for (SamplerType type :
             {SamplerType::independent, SamplerType::stratified, SamplerType::sobol}) {
            RunningStats means, squares;
            for (uint32_t seed = 0; seed < 200; seed++) {
                Film film = film_of(scene, by_twenty(scene), 8, seed, type).film;
                means.add(film.mean());
                squares.add(std::pow(film.standard_error(), 2));
            }
            double ratio = std::sqrt(squares.mean() / means.variance());
            CHECK(ratio > 1 / 1.25);
            CHECK(ratio < 1.25);
            CHECK(std::sqrt(means.variance()) < 0.01 * means.mean());
        }
    }
}

// What must hold in every chapter, and is easily lost in one: lamps seen from behind and from far
// off, skies that are one light among others, things close to a lamp, glass at a grazing angle,
// and the sum over a thousand lights.
#include "tests/support/chapters.h"
#include "tests/support/known_lights.h"

namespace {

std::string at(double x, double y, double z) {
    return "Translate " + std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) +
           " ";
}
std::string two_sided(const std::string& shape) {
    return "AttributeBegin AreaLightSource \"diffuse\" \"bool twosided\" true"
           " Material \"diffuse\" \"rgb reflectance\" [0 0 0]\n" +
           shape + "AttributeEnd\n";
}
std::string lamp(const std::string& L, const std::string& shape) {
    return "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [" + L + " " + L + " " + L +
           "] Material \"diffuse\" \"rgb reflectance\" [0 0 0]\n" + shape + "AttributeEnd\n";
}

/// Irradiance of the unit square at height h, straight overhead.
double irradiance_of_square(double h) {
    double a = 0.5 / h, s = a / std::sqrt(1 + a * a);
    return 4 * s * std::atan(s);
}

/// A pane of glass, upright before a sky of which a black wall hides one half: that behind the eye,
/// or that behind the pane.
Scene pane_before_half_a_sky(bool sky_behind_pane) {
    auto wall = [](double z, bool facing) {
        return at(0, 0, z) + "Rotate -90 1 0 0 Scale 300 1 300 " + square(0, facing);
    };
    Scene scene = world_of("LightSource \"infinite\"\nAttributeBegin Material \"dielectric\" " +
                           wall(0, true) + "AttributeEnd AttributeBegin Material \"dielectric\" " +
                           wall(0.1, false) +
                           "AttributeEnd\nMaterial \"diffuse\" \"rgb reflectance\" [0 0 0] " +
                           wall(sky_behind_pane ? -5 : 5, true));
    scene.max_depth = 1000;
    return scene;
}

/// What all lights give the floor's point x, each one by itself: no choice among them.
Measured sum_over_lights(const Scene& scene, const Hit& x, int samples) {
    double sum = 0, variance = 0;
    Sampler random = random_numbers(1);
    for (size_t i = 0; i < scene.lights.size(); i++) {
        RunningStats one;
        for (int k = 0; k < samples; k++) {
            LightSample y = sample_one_light(scene, i, x, random.u2());
            float cos_x = std::max(0.0f, dot(y.wi, x.n));
            bool lit = y.pdf_w > 0 && cos_x > 0 && !occluded(scene, spawn_ray(x, y.wi, y.dist));
            one.add(lit ? static_cast<double>(average(y.Le) * cos_x / y.pdf_w) : 0);
        }
        sum += one.mean(), variance += one.standard_error() * one.standard_error();
    }
    return {sum, std::sqrt(variance)};
}

}  // namespace

TEST_SUITE("every chapter") {
    TEST_CASE("truth: a two-sided lamp gives the same from behind, near and far") {
        for (double h : {0.5, 3.0, 10.0}) {
            CAPTURE(h);
            // Its front looks up. A second lamp makes chapters choose.
            Scene scene =
                floor_under(two_sided(at(0, h, 0) + "Scale 0.5 1 0.5 " + square(0, true)) +
                            two_sided(at(0, h + 1, 0) + "Scale 0.2 1 0.2 " + square(0, true)));
            for (const Chapter& chapter : every_chapter(scene)) {
                if (chapter.by_chance && h > 5) continue;  // hardly ever met
                CAPTURE(chapter.name);
                RunningStats s = irradiance(scene, chapter.trace, chapter.by_chance ? 60000 : 4000);
                check_bounded(s, irradiance_of_square(h), 0.06);
            }
        }
    }

    TEST_CASE("truth: the sky is one light among others, whatever its number") {
        // It is no light's turn to be first: a lamp of 10 before it, one of 5 behind it.
        std::string tilted = at(3, 1, 0) + "Rotate -60 0 0 1 Scale 0.5 1 0.5 " + square(0, false);
        std::string overhead = lamp("10", unit_square(1)), aside = lamp("5", tilted);
        std::string sky = "LightSource \"infinite\" \"float scale\" 2\n";
        Scene scene = floor_under(aside);
        double of_aside = irradiance(scene, method_of<ch10::trace>(), 400000).mean();
        REQUIRE(of_aside > 0.1);
        double E = 2 * pi_exact + 8 * irradiance_of_square(1) + of_aside * 3 / 5;
        for (const std::string& lights :
             {sky + overhead + aside, overhead + sky + aside, aside + overhead + sky}) {
            scene = floor_under(lights);
            for (const Chapter& chapter : every_chapter(scene)) {
                CAPTURE(chapter.name);
                check_bounded(irradiance(scene, chapter.trace, 20000), E, 0.02);
            }
        }
    }

    TEST_CASE("truth: what is just below a lamp hides it, what is just behind it does not") {
        for (double size : {1.0, 100.0})
            for (double gap : {1e-4, -1e-4}) {
                CAPTURE(size);
                CAPTURE(gap);
                std::string scale = std::to_string(size) + " ";
                Scene scene =
                    floor_under("Scale " + scale + scale + scale + lamp("1", unit_square(1)) +
                                at(0, 1 - gap, 0) + "Scale 0.6 1 0.6 " + square(0, false));
                for (const Chapter& chapter : every_chapter(scene)) {
                    CAPTURE(chapter.name);
                    RunningStats s =
                        irradiance(scene, chapter.trace, chapter.by_chance ? 20000 : 2000);
                    if (gap > 0) {
                        CHECK(s.mean() == 0);
                    } else {
                        check_bounded(s, irradiance_of_square(1), 0.05);
                    }
                }
            }
    }

    TEST_CASE(
        "truth: a pane at a grazing angle before half a sky: (1 - R) / (1 + R), and the rest") {
        // At 80 degrees R = 0.3878: paths run to and fro in the glass, and roulette ends many.
        double a = 80 * pi_exact / 180, cos_t = std::sqrt(1 - std::pow(std::sin(a) / 1.5, 2));
        double s = (std::cos(a) - 1.5 * cos_t) / (std::cos(a) + 1.5 * cos_t);
        double p = (1.5 * std::cos(a) - cos_t) / (1.5 * std::cos(a) + cos_t);
        double R = (s * s + p * p) / 2;
        CHECK(R == doctest::Approx(0.3878).epsilon(1e-3).scale(0));
        Ray ray = {{0, 0, -4},
                   {0, static_cast<float>(std::sin(a)), static_cast<float>(std::cos(a))}};
        for (bool behind_pane : {true, false}) {
            Scene scene = pane_before_half_a_sky(behind_pane);
            double truth = behind_pane ? (1 - R) / (1 + R) : 2 * R / (1 + R);
            for (const Chapter& chapter : every_chapter(scene)) {
                CAPTURE(chapter.name);
                check_bounded(repeat(scene, ray, chapter.trace, 40000), truth, 0.02);
            }
        }
    }

    TEST_CASE("failure: without lights a picture is black, by every chapter") {
        Scene none = floor_without_lights();
        for (const Chapter& chapter : every_chapter(none)) {
            CAPTURE(chapter.name);
            CHECK(irradiance(none, chapter.trace, 100).mean() == 0);
        }
    }

    TEST_CASE("truth: among a thousand lights the choice gives the sum of them all") {
        Scene scene = scene_from("scenes/thousand-lights.pbrt", 32, 1);
        CameraView view = camera_view(scene.camera, 32, 32);
        int points = 0;
        for (Vec2 film : {Vec2{16, 20}, {8, 24}, {24, 28}, {16, 30}}) {
            Ray ray = camera_ray(view, film);
            std::optional<Hit> x = intersect(scene, ray);
            if (!x || x->light >= 0 || x->material->type != MaterialType::diffuse) continue;
            points++;
            Measured all = sum_over_lights(scene, *x, 16);
            double f = static_cast<double>(average(x->material->reflectance)) / pi_exact;
            Measured truth = {f * all.mean, f * all.se};
            for (int M : {1, 16, 64}) {
                CAPTURE(M);
                for (const Method& trace : {method_of<ch12::trace>(ch12::prepare(scene, M)),
                                            method_of<ch15::trace>(ch15::prepare(scene, M))}) {
                    RunningStats s = repeat(scene, ray, trace, M == 1 ? 40000 : 10000);
                    CHECK(z_between({s.mean(), s.standard_error()}, truth) < 5);
                    CHECK(std::hypot(s.standard_error(), truth.se) < 0.03 * truth.mean);
                }
            }
        }
        CHECK(points >= 3);
    }

    TEST_CASE("truth: more lights than candidates, some of them of huge power that light nothing") {
        auto points = [](int n, double I, double x, double y, double r) {
            std::string all, rgb = std::to_string(I) + " ";
            for (int k = 0; k < n; k++) {
                double angle = 2 * pi_exact * k / n;
                all += "AttributeBegin " + at(x + r * std::cos(angle), y, r * std::sin(angle)) +
                       "LightSource \"point\" \"rgb I\" [" + rgb + rgb + rgb + "] AttributeEnd\n";
            }
            return all;
        };
        const std::string sky = "LightSource \"infinite\"\n";
        const std::string sun =
            "LightSource \"distant\" \"point3 from\" [0 1 0]"
            " \"point3 to\" [0 0 0]\n";
        const std::string roof = "AttributeBegin " + at(0, 9, 0) + "Scale 900 1 900 " +
                                 square(0, false) + "AttributeEnd\n";
        const std::string ball =
            "AttributeBegin " + at(20, 5, 0) + "Shape \"sphere\" AttributeEnd\n";
        for (int n : {63, 65, 129, 1000}) {
            const std::string lamps = points(n, 0.0625, 0, 2, 1);
            const double E = n * 0.0625 * 2 / std::pow(5, 1.5);
            for (const auto& [lights, truth] :
                 {std::pair(lamps, E),
                  {sky + lamps, E + pi_exact},
                  {sky + lamps + sun, E + pi_exact + 1},
                  {sun + roof + lamps, E},
                  {ball + points(1, 1e9, 20, 5, 0.5) + lamps, E},
                  {ball + points(n, 1e9, 20, 5, 0.5) + lamps, E},
                  {lamps + points(n, 0, 0, 2, 2) + sky, E + pi_exact}}) {
                CAPTURE(lights.substr(0, 200));
                CAPTURE(n);
                Scene scene = floor_under(lights);
                for (const Chapter& chapter : every_chapter(scene)) {
                    // Chapter 12 rarely keeps a candidate that a brighter one outweighs.
                    if (chapter.by_chance || (chapter.name == "12" && lights.starts_with(ball)))
                        continue;
                    CAPTURE(chapter.name);
                    RunningStats s = irradiance(scene, chapter.trace, 20000);
                    CHECK(std::abs(s.mean() - truth) < 5 * s.standard_error() + 3e-5 * truth);
                    CHECK(s.standard_error() < 0.15 * truth);
                }
            }
        }
    }

    TEST_CASE(
        "furnace: inside a lamp that loses 1 % at a bounce, and inside one that loses nothing") {
        for (const auto& [a, max_depth] : {std::pair(std::string("0.99 "), 100000), {"1 ", 99}}) {
            CAPTURE(max_depth);
            const std::string L = "0.01 0.01 0.01";
            Scene scene = world_of("ReverseOrientation AreaLightSource \"diffuse\" \"rgb L\" [" +
                                   L + "] Material \"diffuse\" \"rgb reflectance\" [" + a + a + a +
                                   "] Shape \"sphere\"");
            scene.max_depth = max_depth;
            for (const Chapter& chapter : every_chapter(scene)) {
                if (chapter.name < "10") continue;  // directions that are uniform: far more noise
                CAPTURE(chapter.name);
                RunningStats s = repeat(scene, {{0, 0, 0}, {0, 0, 1}}, chapter.trace, 2000);
                CHECK(std::abs(s.mean() - 1) < 5 * s.standard_error() + 1e-4);
                CHECK(s.standard_error() < 0.03);
            }
        }
    }
}

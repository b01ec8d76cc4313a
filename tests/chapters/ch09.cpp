// Chapter 09: explicit light sampling: known irradiances, near lights, what counts once.
#include <doctest/doctest.h>

#include <array>

#include "chapters/08_russian_roulette/estimator.h"
#include "chapters/09_light_sampling/estimator.h"
#include "common/results/warnings.h"
#include "tests/support/estimators.h"

using ch09::LightMeasure;

namespace {

const Method trace_by_area = method_of<ch09::trace>(LightMeasure::area);
const Method trace_by_angle = method_of<ch09::trace>(LightMeasure::solid_angle);
const Method both_ways[] = {trace_by_area, trace_by_angle};

SquareMoments square_moments(double h) {  // X = h^2 / d^4
    return moments_of([=](double u, double v) {
        double d2 = h * h + (u - 0.5) * (u - 0.5) + (v - 0.5) * (v - 0.5);
        return h * h / (d2 * d2);
    });
}

}  // namespace

TEST_SUITE("ch09 light sampling") {
    TEST_CASE("truth: a ball above, across and below the horizon") {
        struct Row {
            double R, D, degrees, E;
        };
        for (auto [R, D, degrees, E] : {Row{1, 2, 0, 0.7853981633974},
                                        {1, 2, 30, 0.6801747615878},
                                        {1, 2, 60, 0.3926990816987},
                                        {0.5, 1, 45, 0.5553603672698},
                                        {1, 10, 0, 0.0314159265359},
                                        {1, 1.001, 0, 3.13531888051},
                                        {1, 2, 70, 0.2753750579346},
                                        {1, 2, 90, 0.09058607370608},
                                        {1, 2, 100, 0.03544901531047},
                                        {1, 1.25, 60, 1.076664812262}}) {
            double a = degrees * pi_exact / 180;
            Scene scene = floor_under(shining + "Translate " + std::to_string(D * std::sin(a)) +
                                      " " + std::to_string(D * std::cos(a)) +
                                      " 0 Shape \"sphere\" \"float radius\" " + std::to_string(R));
            check_bounded(irradiance(scene, trace_by_angle, 40000), E, 0.02);
        }
    }

    TEST_CASE("truth: squares overhead, aside, tilted, and cut by the horizon" * doctest::skip()) {
        const std::string wall = "Translate 0 0 1 Rotate -90 1 0 0 " + square(0, true);
        for (const auto& [light, E] : std::vector<std::pair<std::string, double>>{
                 {unit_square(1), 0.7522746884541},
                 {unit_square(1, 0.5, 0.5), 0.4352098756836},
                 {unit_square(2), 0.2308367977302},
                 {"Scale 2 1 1 " + unit_square(1), 1.133290224099},
                 {unit_square(1, 1.5), 0.1046370751909},
                 {"Translate 0.5 0.5 1 Rotate -90 1 0 0 Scale 0.5 1 0.5 " + square(0, true),
                  0.1750941438569},
                 {wall, 0.3501882877139},  // its lower half is below the floor
                 {"Rotate 45 0 0 1 " + unit_square(1), 0.5319385335209},
                 {"Rotate 45 0 0 1 Translate 0 1 0 Scale 3 1 3 " + square(0, false),
                  2.184409062828},
                 {unit_square(10), 0.9966782906402 / 100}}) {
            Scene scene = floor_under(shining + light);
            for (const Method& trace : both_ways) {
                check_bounded(irradiance(scene, trace, 100000), E, 0.007);
            }
        }
        for (auto [h, E] : {std::pair{0.1, 3.04212843837}, {0.01, 3.140564683433}}) {
            Scene scene = floor_under(shining + unit_square(h));
            check_bounded(irradiance(scene, trace_by_angle, 40000), E, 0.004);
        }
    }

    TEST_CASE("truth: point and distant lights are exact, sample by sample") {
        auto exactly = [](const std::string& light, double E) {
            Scene scene = floor_under(light);
            RunningStats s = irradiance(scene, trace_by_angle, 100);
            CHECK(s.mean() == doctest::Approx(E).epsilon(1e-6).scale(0));
            CHECK(s.variance() <= 1e-12 * E * E);
        };
        exactly("LightSource \"point\" \"point3 from\" [1 2 0]", 0.1788854382);
        exactly("LightSource \"point\" \"point3 from\" [0 .001 0]", 1e6);
        exactly("LightSource \"distant\" \"point3 from\" [0 1 0] \"point3 to\" [0 0 0]", 1);
        exactly("LightSource \"distant\" \"point3 from\" [0 3 4] \"point3 to\" [0 0 0]", 0.6);
    }

    TEST_CASE("truth: the factor that the light's cosine, area, albedo/pi and N make") {
        // Le cos_x / d^2, the mean over a unit light: 0.8054 and 0.2354; right, for albedo 1/2:
        // 0.5 E / pi. The slide is 6.73 and 6.41 times too bright.
        for (auto [h, wrong, factor] : {std::tuple{1.0, 0.8054316831613, 6.727165748426},
                                        {2.0, 0.2354300237883, 6.40820909353}}) {
            Scene scene = floor_under(shining + unit_square(h));
            RunningStats slide;
            Sampler random = random_numbers(1);
            for (int i = 0; i < 100000; i++) {
                LightPoint y = sample_area(scene, 0, random.u2());
                double d2 = static_cast<double>(dot(y.p, y.p));
                slide.add(static_cast<double>(y.p.y) / std::sqrt(d2) / d2);
            }
            check_bounded(slide, wrong, 0.001);
            double right = 0.5 * irradiance(scene, trace_by_angle, 100000).mean() / pi_exact;
            CHECK(slide.mean() / right == doctest::Approx(factor).epsilon(0.005).scale(0));
        }
    }

    TEST_CASE("density: each of N lights is chosen equally often") {
        // Lights 0 .. 9 of radiance 1 .. 10, far above: the sample's Le says which it was.
        std::string lights = "Material \"diffuse\" \"rgb reflectance\" [0 0 0]\n";
        for (int i = 0; i < 10; i++)
            lights += "AttributeBegin AreaLightSource \"diffuse\" \"float scale\" " +
                      std::to_string(i + 1) + " " + unit_square(9, 2 * i) + " AttributeEnd\n";
        Scene scene = floor_under(lights);
        Hit x = origin_of(scene);
        std::array<double, 10> counts{};
        Sampler random = random_numbers(1);
        for (int i = 0; i < 100000; i++) {
            float u1 = random.u1();
            ch09::LightSample y =
                ch09::sample_light(scene, x, u1, random.u2(), LightMeasure::solid_angle);
            REQUIRE(y.pdf_w > 0);
            size_t light = static_cast<size_t>(std::lround(y.Le.g)) - 1;
            counts[light]++;
            if (i >= 100) continue;
            // The density is that of the point, divided by N.
            Hit hit = *intersect(scene, spawn_ray(x, y.wi));
            CHECK(hit.light == static_cast<int>(light));
            CHECK(y.pdf_w * 10 ==
                  doctest::Approx(pdf_solid_angle(scene, light, x.p, hit)).epsilon(1e-4).scale(0));
        }
        CHECK(chi_square_tail(chi_square(counts), 9) > 1e-6);
    }

    TEST_CASE("truth: N equal lights give N times the light of one") {
        std::string lights;
        for (const char* turn : {"0", "90", "180", "270"})
            lights += "AttributeBegin " + shining + "Rotate " + turn + " 0 1 0 " +
                      unit_square(1, 1.5) + " AttributeEnd\n";
        check_bounded(irradiance(floor_under(lights), trace_by_angle, 100000), 4 * 0.1046370751909,
                      0.002);
    }

    TEST_CASE(
        "truth: a light counts once: directly seen, on the floor, in a mirror, through glass") {
        // On the floor, albedo 1/2: radiance E / (2 pi); the light itself: 1, exactly.
        Scene scene = floor_under(shining + unit_square(1));
        scene.max_depth = 10;
        RunningStats floor = repeat(scene, onto_origin, trace_by_angle, 40000, 1, 0.5);
        double relative = square_moments(1).variance / std::pow(square_moments(1).mean, 2);
        CHECK(relative == doctest::Approx(0.03035451318485).epsilon(1e-4).scale(0));
        check_mean(floor, 0.1197282352, std::pow(0.1197282352, 2) * 0.001873136382573, 0.001);
        RunningStats light = repeat(scene, {{0, 0.5f, 0}, {0, 1, 0}}, trace_by_angle, 100);
        CHECK(light.mean() == 1);
        CHECK(light.variance() == 0);
        // In a mirror of reflectance 0.9, straight on: 0.9. Through a slab of glass: 0.9231.
        Scene mirror =
            world_of("Material \"conductor\" \"rgb reflectance\" [.9 .9 .9] Shape \"sphere\"\n" +
                     shining + "Translate 0 0 -9 Rotate -90 1 0 0 Scale 9 1 9 " + square(0, false));
        RunningStats in_mirror = repeat(mirror, {{0, 0, -4}, {0, 0, 1}}, trace_by_angle, 100);
        CHECK(in_mirror.mean() == doctest::Approx(0.9).epsilon(1e-5).scale(0));
        CHECK(in_mirror.variance() <= 1e-12);
        Scene slab = world_of(
            "Material \"dielectric\" Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3]"
            " \"point3 P\" [-50 -50 0  -50 50 0  50 50 0  50 -50 0]\n"
            "Shape \"trianglemesh\" \"integer indices\" [0 2 1 0 3 2]"
            " \"point3 P\" [-50 -50 0.1  -50 50 0.1  50 50 0.1  50 -50 0.1]\n" +
            shining +
            "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3]"
            " \"point3 P\" [-900 -900 9  -900 900 9  900 900 9  900 -900 9]");
        RunningStats through = repeat(slab, {{0, 0, -4}, {0, 0, 1}}, trace_by_angle, 40000);
        double T = 0.9230769230769;
        check_mean(through, T, T * (1 - T), 0.02);
    }

    TEST_CASE("truth: light shines from its front only, unless the file says otherwise") {
        for (bool two_sided : {false, true})
            for (bool up : {false, true}) {
                Scene scene = floor_under("AreaLightSource \"diffuse\" \"bool twosided\" " +
                                          std::string(two_sided ? "true" : "false") +
                                          " Translate 0 1 0 Scale 0.5 1 0.5 " + square(0, up));
                for (const Method& trace : both_ways) {
                    RunningStats s = irradiance(scene, trace, 10000);
                    if (up && !two_sided) {
                        CHECK(s.mean() == 0);
                    } else {
                        check_bounded(s, 0.7522746884541, 0.002);
                    }
                }
            }
    }

    TEST_CASE("truth: a board in between takes all light away, half a board takes half") {
        const std::string board = "AttributeBegin Translate 0 0.5 0 " + square(0, true);
        Scene covered = floor_under(board + " AttributeEnd\n" + shining + unit_square(1));
        CHECK(irradiance(covered, trace_by_angle, 1000).mean() == 0);
        Scene half = floor_under("AttributeBegin Translate 1 0.5 0 " + square(0, true) +
                                 " AttributeEnd\n" + shining + unit_square(1));
        half.max_depth = 1;
        check_bounded(irradiance(half, trace_by_angle, 40000), 0.7522746884541 / 2, 0.006);
    }
}

TEST_SUITE("ch09 near lights") {
    TEST_CASE("variance: near-light, a disk, by solid angle: below 1/3 at any height") {
        // R = 1: Omega of the bounding square over that of the disk, times 1 + the disk's own.
        for (auto [h, own] : {std::pair{1.0, 0.009812417174286},
                              {0.5, 0.04863267791677},
                              {0.1, 0.2235883582194},
                              {0.01, 0.3202633598833}}) {
            double square = 4 * std::atan(1 / (h * std::sqrt(2 + h * h)));
            double round = 2 * pi_exact * (1 - h / std::sqrt(1 + h * h));
            double relative = square / round * (1 + own) - 1, E = pi_exact / (1 + h * h);
            CHECK(relative < 1.0 / 3);
            Scene scene = floor_under(shining + disk(1, h));
            RunningStats s = irradiance(scene, trace_by_angle, 100000);
            check_mean(s, E, relative * E * E, 0.02 * E);
            check_variance(s, relative * E * E, 4);
        }
    }

    TEST_CASE("failure: in the light's plane, at a point light, without lights: 0, and finite") {
        for (const Method& trace : both_ways) {
            Scene level = floor_under(shining + "Translate 5 0 0 " + square(0, false));
            CHECK(irradiance(level, trace, 1000).mean() == 0);
        }
        Scene none = floor_under(shining + unit_square(1));
        none.lights.clear();
        CHECK(irradiance(none, trace_by_angle, 1000).mean() == 0);
        Scene touching = floor_under("LightSource \"point\" \"point3 from\" [0 0 0]");
        Sampler random = random_numbers(1);
        float u1 = random.u1();
        ch09::LightSample y = ch09::sample_light(touching, origin_of(touching), u1, random.u2(),
                                                 LightMeasure::solid_angle);
        CHECK(y.pdf_w == 0);
    }
}

TEST_SUITE("ch09 pictures") {
    TEST_CASE("agreement: pictures, lengths and classes of paths with chapter 08" *
              doctest::skip()) {
        for (const auto& [name, least] :
             std::vector<std::pair<std::string, int>>{{"cornell", 6},
                                                      {"cornell-spheres", 8},
                                                      {"color-bleeding", 6},
                                                      {"near-light", 2},
                                                      {"two-lights", 2},
                                                      {"light-in-glass", 4}}) {
            Scene scene = scene_from("scenes/" + name + ".pbrt", 32, 8);
            CHECK(check_classes(scene, ch08::trace, scene, trace_by_angle, 80000) >= least);
        }
        Scene scene = scene_from("scenes/color-bleeding.pbrt", 32, 8);
        check_agreement(hold_against(film_of(scene, trace_by_angle, 64).film,
                                     film_of(scene, ch08::trace, 128, 2).film),
                        0.02);
    }

    TEST_CASE(
        "failure: nobody samples a light in glass: all its light comes by LSS, found by chance") {
        Scene scene = scene_from("scenes/light-in-glass.pbrt", 32, 8);
        PathCensus census = census_of(scene, trace_by_angle, 40000, 1);
        for (const auto& [name, part] : census.by_class) {
            CHECK((name.substr(0, 3) == "LSS" || part.sum == 0));
        }
        CHECK(census.all.sum > 0);
        Film a = film_of(scene, ch08::trace, 64).film, b = film_of(scene, trace_by_angle, 64).film;
        CHECK(rel_mse(b) == doctest::Approx(rel_mse(a)).epsilon(0.2).scale(0));
    }

    TEST_CASE("variance: on the Cornell box, a twentieth of the variance of chapter 08") {
        Scene scene = scene_from("scenes/cornell.pbrt", 32, 8);
        double before = rel_mse(film_of(scene, ch08::trace, 512).film);
        double now = rel_mse(film_of(scene, trace_by_angle, 128).film);
        CHECK(now < before / 20);
    }

    TEST_CASE("failure: where intervals do not cover the truth, a warning says so") {
        // A lamp of radius 3 mm in the middle of a glass ball: its light goes straight through,
        // less 4 % at each surface, and a shadow ray meets the glass. A dim sky lights the floor as
        // well.
        auto room = [](bool in_glass) {
            std::string lamp =
                "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [1e6 1e6 1e6] Material "
                "\"diffuse\" \"rgb reflectance\" [0 0 0] Translate 0 1 0 Shape \"sphere\" "
                "\"float radius\" 0.003 AttributeEnd\n";
            std::string glass =
                "AttributeBegin Material \"dielectric\" Translate 0 1 0 "
                "Shape \"sphere\" \"float radius\" 0.4 AttributeEnd\n";
            Scene scene = scene_of(
                "LookAt 0 0.3 -2  0 0 0  0 1 0 Camera \"perspective\" WorldBegin\n"
                "LightSource \"infinite\" \"rgb L\" [0.02 0.02 0.02]\n" +
                lamp + (in_glass ? glass : "") + square(0, true));
            scene.width = scene.height = 32, scene.max_depth = 6;
            return scene;
        };
        Scene scene = room(true);
        Rendering seen = film_of(scene, trace_by_angle, 64),
                  truth = film_of(room(false), trace_by_angle, 64);
        double mean = seen.film.mean(), se = seen.film.standard_error();
        CAPTURE(mean);
        CAPTURE(se);
        CHECK(0.9 * truth.film.mean() > 2 * mean);
        CHECK(0.9 * truth.film.mean() - mean > 100 * se);
        auto told = [](const Scene& s, const Rendering& r) {
            std::vector<std::string> lines = warnings_of(s, RenderOptions{}, r);
            return std::any_of(lines.begin(), lines.end(), [](const std::string& line) {
                return line.find("is found only by chance") != std::string::npos;
            });
        };
        CHECK(told(scene, seen));
        CHECK_FALSE(told(room(false), truth));
    }
}

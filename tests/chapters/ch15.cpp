// Chapter 15: three ways at once, the same candidates as chapter 12's, and what its heuristics may
// do.
#include <doctest/doctest.h>

#include <array>

#include "chapters/12_ris/estimator.h"
#include "chapters/14_mis/estimator.h"
#include "chapters/15_mis_ris/estimator.h"
#include "tests/support/known_lights.h"
#include "tests/support/plates.h"

namespace {

/// Of one direction, by each way.
struct Densities {
    float any, best, bsdf;
};

Trace by_twelve(const Scene& scene, int M = 16) {
    return trace_with<ch12::trace>(ch12::prepare(scene, M));
}
Trace by_fourteen(const Scene& scene) { return trace_with<ch14::trace>(ch14::prepare(scene)); }
Trace by_fifteen(const Scene& scene, int M = 64) {
    return trace_with<ch15::trace>(ch15::prepare(scene, M));
}

/// Three lights of very unequal power and distance over a floor of rough metal or of paint.
Scene three_lights(const std::string& material) {
    auto light = [](const std::string& L, const std::string& shape) {
        return "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [" + L + " " + L + " " + L +
               "]\n" + shape + "AttributeEnd\n";
    };
    std::string black = "Material \"diffuse\" \"rgb reflectance\" [0 0 0]\n";
    Scene scene = world_of(
        "AttributeBegin " + material + " Scale 500 1 500 " + square(0, true) + "AttributeEnd\n" +
        black + light("1", unit_square(0.5, 1.5)) + light("20", disk(0.5, 3, 1)) +
        light("300", "Translate -1 2 1 Shape \"sphere\" \"float radius\" 0.1\n"));
    scene.max_depth = 1;
    return scene;
}
const std::string paint = "Material \"diffuse\" \"rgb reflectance\" [1 1 1]";
const std::string metal =
    "Material \"conductor\" \"rgb reflectance\" [.9 .9 .9] \"float roughness\" 0.3"
    " \"bool remaproughness\" false";

}  // namespace

TEST_SUITE("ch15 weights") {
    TEST_CASE("identity: the three weights sum to 1") {
        const float inf = infinity;
        std::vector<Densities> table = {{1, 2, 3},           {0, 0, 5},
                                        {3e19f, 1, 3e19f},   {1e-23f, 1e-24f, 0},
                                        {3e38f, 1e-38f, 1},  {inf, 1, 2},
                                        {0, 7, inf},         {1e-38f, 1e-38f, 1e-38f},
                                        {1e-45f, 0, 1e-40f}, {3e38f, 3e38f, 3e38f}};
        Sampler random = random_numbers(1);
        for (int i = 0; i < 10000; i++) {
            auto density = [&] { return std::pow(10.0f, 20 * random.u1() - 10); };
            float a = density(), b = density();
            table.push_back({a, b, density()});
        }
        for (const Densities& d : table) {
            CAPTURE(d.any);
            CAPTURE(d.best);
            CAPTURE(d.bsdf);
            double sum = 0;
            for (auto [a, b, c] : {std::array{d.any, d.best, d.bsdf},
                                   {d.best, d.any, d.bsdf},
                                   {d.bsdf, d.any, d.best}}) {
                if (a == 0) continue;  // draws nothing
                float weight = ch15::mis_weight(a, b, c);
                CHECK(weight >= 0);
                CHECK(weight <= 1);
                sum += static_cast<double>(weight);
            }
            CHECK(sum == doctest::Approx(1).epsilon(1e-6).scale(0));
        }
    }

    TEST_CASE("identity: where one way draws nothing, the two others share as in chapter 14") {
        Sampler random = random_numbers(1);
        for (int i = 0; i < 1000; i++) {
            float a = random.u1() + 0.01f, b = 3 * random.u1() + 0.01f;
            float expected = ch14::power_heuristic(a, b);
            CHECK(ch15::mis_weight(a, 0, b) == expected);
            CHECK(ch15::mis_weight(a, b, 0) == expected);
        }
    }

    TEST_CASE("identity: any positive numbers for the densities keep the mean") {
        // pdf_best() asks the table's pmf, and nothing else does: what is drawn, and what W says
        // of it, stays as it is. Plant numbers that have nothing to do with either.
        for (const std::string& material : {paint, metal}) {
            Scene scene = three_lights(material);
            ManyLights honest = ch15::prepare(scene, 2);
            RunningStats truth =
                repeat(scene, onto_origin, trace_with<ch15::trace>(honest), 200000, 1);
            Sampler random = random_numbers(1);
            for (int i = 0; i < 8; i++) {
                CAPTURE(i);
                ManyLights silly = honest;
                for (AliasColumn& column : silly.table)
                    column.pmf = std::pow(10.0f, 4 * random.u1() - 3);
                RunningStats s = repeat(scene, onto_origin, trace_with<ch15::trace>(silly), 100000,
                                        static_cast<uint32_t>(2 + i));
                CHECK(z_between({truth.mean(), truth.standard_error()},
                                {s.mean(), s.standard_error()}) < 5);
                CHECK(s.standard_error() < 0.02 * s.mean());
            }
        }
    }

    TEST_CASE("teeth: a wrong pmf where candidates are weighed does move the mean") {
        Scene scene = three_lights(paint);
        ManyLights honest = ch15::prepare(scene, 2), wrong = honest;
        wrong.bounds[2].inv_pmf *= 1.1f;
        RunningStats truth = repeat(scene, onto_origin, trace_with<ch15::trace>(honest), 200000, 1);
        RunningStats s = repeat(scene, onto_origin, trace_with<ch15::trace>(wrong), 200000, 2);
        CHECK(z_between({truth.mean(), truth.standard_error()}, {s.mean(), s.standard_error()}) >
              5);
    }
}

TEST_SUITE("ch15 candidates") {
    TEST_CASE("identity: candidates all at once are those of chapter 12") {
        const std::string all_kinds =
            square(0, false) + "LightSource \"point\" \"point3 from\" [1 2 0]" +
            "LightSource \"distant\" \"point3 to\" [1 -2 3] LightSource \"infinite\"\n" +
            "AttributeBegin " + shining + "Translate 1 1 0 Shape \"sphere\" AttributeEnd " +
            "AttributeBegin " + shining + "Rotate 70 1 2 3 Shape \"disk\" AttributeEnd " +
            "AreaLightSource \"diffuse\" \"bool twosided\" true Translate 0 3 0 " +
            square(0, false);
        for (Scene scene :
             {world_of(all_kinds), scene_from("scenes/thousand-lights.pbrt", 16, 1)}) {
            LightTable table = ch12::prepare(scene, 1).lights;
            Sampler random = random_numbers(1);
            int gave = 0;
            for (int k = 0; k < 2000; k++) {
                Hit x{};
                x.p = scene.radius * random.u1() * uniform_direction(random.u2());
                x.n = x.ng = uniform_direction(random.u2());
                ManyLights lights = many_lights(scene, table, 1 + k % 70);
                int M = lights.M;
                double u = to_unit_double(random.u2());
                Candidates c = draw_candidates(lights, x, u);
                REQUIRE(c.M == M);
                for (int i = 0; i < M; i++) {
                    size_t light = static_cast<size_t>(c.light[i]);
                    REQUIRE(light == pick_light(table, (i + u) * (1.0 / M)));
                    float p_hat = ch12::target(scene, light, x);
                    REQUIRE(std::abs(c.p_hat[i] - p_hat) <= 1e-5f * p_hat);
                    float weight = p_hat / pmf_light(table, light);
                    REQUIRE(std::abs(c.weight[i] - weight) <= 1e-5f * weight);
                    if (p_hat > 0) gave++;
                }
            }
            CHECK(gave > 5000);
        }
    }

    TEST_CASE("identity: each candidate is kept for its share of u") {
        Sampler random = random_numbers(1);
        for (int M : {1, 2, 7, 16, 100, Candidates::most}) {
            CAPTURE(M);
            Candidates c{};
            c.M = M;
            double sum = 0;
            for (int i = 0; i < M; i++) {
                c.light[i] = 3 * i;
                c.p_hat[i] = i % 3 == 1 ? 0 : random.u1() + 0.1f;
                c.weight[i] = c.p_hat[i] * (1 + 9 * random.u1());
                sum += static_cast<double>(c.weight[i]);
            }
            constexpr int steps = 1 << 16;
            std::vector<int> count(static_cast<size_t>(M));
            for (int k = 0; k < steps; k++) {
                Kept kept = keep_one(c, (static_cast<float>(k) + 0.5f) / steps);
                int i = static_cast<int>(kept.light) / 3;
                REQUIRE(kept.W ==
                        doctest::Approx(sum / M / double{c.p_hat[i]}).epsilon(1e-5).scale(0));
                count[static_cast<size_t>(i)]++;
            }
            for (int i = 0; i < M; i++) {
                double share = static_cast<double>(c.weight[i]) / sum * steps;
                CHECK(std::abs(count[static_cast<size_t>(i)] - share) < (share > 0 ? 2 : 0.5));
            }
        }
    }

    TEST_CASE("failure: no candidate gives light, or too little for float: none is kept") {
        Candidates c{};
        c.M = 16;
        CHECK(keep_one(c, 0.5f).W == 0);
        c.weight[7] = c.p_hat[7] = 1e-42f;
        for (float u : {0.0f, 0.5f, 0x1.fffffep-1f}) CHECK(keep_one(c, u).W == 0);
        c.weight[7] = c.p_hat[7] = 1e-37f;
        for (float u : {0.0f, 0.5f, 0x1.fffffep-1f})
            CHECK(keep_one(c, u).W == doctest::Approx(1 / 16.0).epsilon(1e-5).scale(0));
    }

    TEST_CASE("failure: weights beyond float: one of the candidates, and a sample that is seen") {
        Candidates c{};
        c.M = Candidates::most;
        for (int i = 0; i < c.M; i++) c.light[i] = i, c.p_hat[i] = c.weight[i] = 1e38f;
        for (float u : {0.0f, 0.5f, 0x1.fffffep-1f}) {
            Kept kept = keep_one(c, u);
            CHECK(kept.light < Candidates::most);
            CHECK(!std::isfinite(kept.W));
        }
    }
}

TEST_SUITE("ch15 mis ris") {
    TEST_CASE("truth: irradiance of all lights") {
        for (const auto& [light_here, E] : lights_of_known_irradiance) {
            const auto& light = light_here;
            CAPTURE(light);
            Scene scene = floor_under(light);
            for (int M : {1, 2, 64})
                check_bounded(irradiance(scene, by_fifteen(scene, M), 20000), E, 0.025);
        }
    }

    TEST_CASE("truth: point and distant lights, which only aiming finds") {
        for (const auto& [light, E] : lights_without_size) {
            Scene scene = floor_under(light);
            RunningStats s = irradiance(scene, by_fifteen(scene), 100);
            CHECK(s.mean() == doctest::Approx(E).epsilon(1e-5).scale(0));
            CHECK(s.variance() < 1e-10);
        }
    }

    TEST_CASE("truth: a light in a mirror and straight on, without noise") {
        Scene mirror = light_before_mirror();
        check_light_before_mirror(mirror, by_fifteen(mirror));
    }

    TEST_CASE("failure: without lights the picture is black") {
        Scene none = floor_without_lights();
        CHECK(irradiance(none, by_fifteen(none), 100).mean() == 0);
    }

    TEST_CASE("agreement: pictures, lengths and classes of paths with chapter 12") {
        for (const auto& [name_here, least] :
             std::vector<std::pair<std::string, int>>{{"cornell", 6},
                                                      {"cornell-spheres", 8},
                                                      {"two-lights", 4},
                                                      {"far-and-near", 2},
                                                      {"color-bleeding", 6},
                                                      {"thousand-lights", 4},
                                                      {"near-light", 2},
                                                      {"light-in-glass", 4},
                                                      {"horizon-sky", 2}}) {
            const auto& name = name_here;
            CAPTURE(name);
            Scene scene = scene_from("scenes/" + name + ".pbrt", 32, 8);
            CHECK(check_classes(scene, by_twelve(scene), scene, by_fifteen(scene), 20000) >= least);
        }
    }

    TEST_CASE("agreement: pictures, lengths and classes of paths with chapter 14 on plates") {
        Scene scene = scene_from("scenes/veach-mis.pbrt", 32, 6);
        for (int M : {1, 4})
            CHECK(check_classes(scene, by_fourteen(scene), scene, by_fifteen(scene, M), 60000) >=
                  6);
        Film a = film_of(scene, by_fourteen(scene), 128).film;
        Film b = film_of(scene, by_fifteen(scene), 128, 2).film;
        check_agreement(hold_against(a, b, 16), 0.1);
    }

    TEST_CASE("agreement: each plate with all lamps, with chapter 14, and hardly more variance") {
        Scene scene = scene_from("scenes/veach-mis.pbrt", 32, 1);
        for (size_t plate = 0; plate < 4; plate++)
            for (size_t lamp = 0; lamp < 4; lamp++) {
                CAPTURE(plate);
                CAPTURE(lamp);
                Ray ray = PlateAndLamp(plate, lamp).ray;
                RunningStats a = repeat(scene, ray, by_fourteen(scene), 100000, 1);
                RunningStats b = repeat(scene, ray, by_fifteen(scene), 50000, 2);
                CHECK(z_between({a.mean(), a.standard_error()}, {b.mean(), b.standard_error()}) <
                      5);
                CHECK(b.standard_error() < 0.005 * b.mean());
                CHECK(relative_variance(b) < relative_variance(a) + 0.15);
            }
    }

    TEST_CASE("agreement: behind a wall, classes of paths with chapter 14") {
        Scene scene = scene_from("scenes/hidden-light.pbrt", 32, 8);
        CHECK(check_classes(scene, by_fourteen(scene), scene, by_fifteen(scene), 100000) >= 4);
    }

    TEST_CASE("variance: a thousand lights: a third of the relMSE of chapter 12") {
        Scene scene = scene_from("scenes/thousand-lights.pbrt", 64, 8);
        double twelve = rel_mse(film_of(scene, by_twelve(scene), 16).film);
        double fifteen = rel_mse(film_of(scene, by_fifteen(scene), 16).film);
        CHECK(fifteen < twelve / 3);
    }

    TEST_CASE("failure: near a light no sample is much brighter than the light") {
        // Where targets misjudge near lights, a few samples weigh ten times too much.
        for (std::string name :
             {"scenes/near-light", "tests/pictures/references/tiny-close-light"}) {
            CAPTURE(name);
            Scene scene = scene_from(name + ".pbrt", 64, 8);
            float brightest = 0;
            for (const Light& light : scene.lights)
                brightest = std::max(brightest, max_component(light.L));
            for (const Trace& trace : {by_twelve(scene), by_fifteen(scene)}) {
                Rendering r = film_of(scene, trace, 64);
                CHECK(r.stats.largest < 1.5 * double{brightest});
            }
        }
    }

    TEST_CASE("variance: a bright light behind a wall: the even way finds what target misjudges") {
        Scene scene = scene_from("scenes/hidden-light.pbrt", 32, 8);
        double twelve = rel_mse(film_of(scene, by_twelve(scene), 64).film);
        double fifteen = rel_mse(film_of(scene, by_fifteen(scene), 64).film);
        CHECK(fifteen < twelve / 10);
    }
}

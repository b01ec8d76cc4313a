// Chapter 15: which two lights are sampled, how likely each is, and that no heuristic moves the
// mean.
#include <doctest/doctest.h>

#include <numeric>
#include <utility>

#include "chapters/12_ris/estimator.h"
#include "chapters/14_mis/estimator.h"
#include "chapters/15_mis_ris/estimator.h"
#include "common/light/resampling.h"
#include "tests/support/known_lights.h"
#include "tests/support/plates.h"

namespace {

Method by_twelve(const Scene& scene, int M = 16) {
    return method_of<ch12::trace>(ch12::prepare(scene, M));
}
Method by_fourteen(const Scene& scene) { return method_of<ch14::trace>(ch14::prepare(scene)); }
Method by_fifteen(const Scene& scene, int M = 64) {
    return method_of<ch15::trace>(ch15::prepare(scene, M));
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

/// Lights of every type above and below the origin, two of them two-sided.
Scene all_kinds() {
    return world_of(square(0, false) + "LightSource \"point\" \"point3 from\" [1 2 0]" +
                    "LightSource \"distant\" \"point3 to\" [1 -2 3] LightSource \"infinite\"\n" +
                    "AttributeBegin " + shining + "Translate 1 1 0 Shape \"sphere\" AttributeEnd " +
                    "AttributeBegin " + shining + "Rotate 70 1 2 3 Shape \"disk\" AttributeEnd " +
                    "AreaLightSource \"diffuse\" \"bool twosided\" true Translate 0 3 0 " +
                    square(0, false));
}

/// A point of a diffuse surface anywhere in the scene.
Hit somewhere(const Scene& scene, Sampler& random) {
    static const Material paint_all{};
    Hit x{};
    x.p = scene.radius * random.u1() * uniform_direction(random.u2());
    x.n = x.ng = uniform_direction(random.u2());
    x.material = &paint_all;
    return x;
}

/// Inclusion probabilities by the page's formula, in double precision, with c by bisection.
std::vector<double> inclusions(const std::vector<double>& w) {
    double mean = std::accumulate(w.begin(), w.end(), 0.0) / static_cast<double>(w.size());
    auto sum_with = [&](double c) {
        double sum = 0;
        for (double w_i : w) sum += std::min(1.0, c * (w_i + mean / 9));
        return sum;
    };
    double low = 0, high = 1e30;
    for (int k = 0; k < 2000; k++) {
        double middle = k < 300 ? std::sqrt(std::max(low, 1e-30) * high) : (low + high) / 2;
        (sum_with(middle) < 2 ? low : high) = middle;
    }
    std::vector<double> result;
    for (double w_i : w) result.push_back(std::min(1.0, high * (w_i + mean / 9)));
    return result;
}

}  // namespace

TEST_SUITE("ch15 two lights") {
    TEST_CASE("identity: targets without a branch are those of the four formulas") {
        for (const Scene& scene : {all_kinds(), scene_from("scenes/thousand-lights.pbrt", 16, 1)}) {
            Sampler random = random_numbers(1);
            int gave = 0;
            for (int k = 0; k < 20000; k++) {
                Hit x = somewhere(scene, random);
                size_t i = static_cast<size_t>(k) % scene.lights.size();
                double expected = p_hat_by_type(scene, i, x);
                double found = double{target(light_bounds(scene, i), x)};
                // Where a light is about to be hidden, the last bits of a cosine decide.
                LightBounds y = light_bounds(scene, i);
                Vec3 to_y = y.centre - y.has_place * x.p;
                float d = std::max({length(to_y), y.radius, 1e-5f}), least = y.radius / d;
                if (std::abs(dot(to_y, x.n) / d + least) < 1e-4f) continue;
                if (std::abs(std::abs(dot(to_y, y.n) / d) - least) < 1e-4f) continue;
                double facing = double{y.power / (d * d)};
                REQUIRE(std::abs(found - expected) <= 1e-4 * expected + 1e-6 * facing);
                if (expected > 0) gave++;
            }
            CHECK(gave > 5000);
        }
    }

    TEST_CASE("identity: inclusions are min(1, c (w + mean w / 9)), and sum to 2") {
        for (const Scene& scene : {all_kinds(), scene_from("scenes/thousand-lights.pbrt", 16, 1)}) {
            Sampler random = random_numbers(1);
            for (int k = 0; k < 2000; k++) {
                int N = static_cast<int>(scene.lights.size()), M = 3 + k % 70;
                ch15::Lights lights = ch15::prepare(scene, M);
                double all =
                    std::accumulate(lights.candidates.begin(), lights.candidates.end(), 0.0);
                REQUIRE(std::abs(all - std::min(N, M)) < 1e-3);
                REQUIRE(std::ranges::max(lights.candidates) < 1.00001f);
                Hit x = somewhere(scene, random);
                double u = to_unit_double(random.u2());
                ch15::Candidates c;
                ch15::choose_candidates(scene, lights, x, x.n, u, c);
                if (c.size == 0) continue;
                REQUIRE(c.size == std::min(N, M));
                std::vector<double> w;
                for (int i = 0; i < c.size; i++) {
                    size_t light = c.light[i];
                    int always = N <= M ? N : static_cast<int>(lights.always.size());
                    double drawn = M - always;
                    size_t expected = N <= M ? static_cast<size_t>(i)
                                      : i < always
                                          ? lights.always[static_cast<size_t>(i)]
                                          : pick_light(lights.table, (i - always + u) / drawn);
                    REQUIRE(light == expected);
                    double candidates =
                        i < always ? 1 : drawn * double{pmf_light(lights.table, light)};
                    w.push_back(p_hat_by_type(scene, light, x) / candidates);
                }
                std::vector<double> expected = inclusions(w);
                double sum = 0;
                for (int i = 0; i < c.size; i++) {
                    double inclusion = double{c.inclusion[i]};
                    REQUIRE(std::abs(inclusion - expected[static_cast<size_t>(i)]) < 1e-3);
                    sum += inclusion;
                }
                REQUIRE(std::abs(sum - 2) < 1e-3);
            }
        }
    }

    TEST_CASE("identity: each candidate is included for its share of u") {
        Scene scene = three_lights(paint);
        for (int M : {1, 2, 3, 64}) {
            CAPTURE(M);
            ch15::Lights lights = ch15::prepare(scene, M);
            Hit x = origin_of(scene);
            ch15::Candidates c;
            ch15::choose_candidates(scene, lights, x, x.n, 0.4, c);
            REQUIRE(c.size == std::min(M, 3));
            for (int i = 0; i < c.size; i++) {
                // Only this candidate shines.
                Scene dark = scene;
                for (size_t k = 0; k < 3; k++) dark.lights[k].L *= k == c.light[i] ? 1.0f : 0.0f;
                constexpr int steps = 1 << 12;
                int included = 0;
                for (int k = 0; k < steps; k++) {
                    float u = (static_cast<float>(k) + 0.5f) / steps;
                    Recorder recorder;
                    Rgb Ld = ch15::direct_light(dark, lights, c, {0, u, {0.5f, 0.5f}, {0.5f, 0.5f}},
                                                recorder);
                    included += is_black(Ld) ? 0 : 1;
                }
                CHECK(std::abs(included - double{c.inclusion[i]} * steps) < 2);
            }
        }
    }

    TEST_CASE("identity: one or two lights are always included, whatever their targets") {
        const std::string far =
            shining + "Translate 9 9 9 Shape \"sphere\" \"float radius\" 1e-3\n";
        for (const std::string& light : {far, "LightSource \"infinite\"\n" + far}) {
            Scene scene = world_of(light);
            ch15::Lights lights = ch15::prepare(scene);
            Sampler random = random_numbers(1);
            for (int k = 0; k < 1000; k++) {
                ch15::Candidates c;
                Hit x = somewhere(scene, random);
                ch15::choose_candidates(scene, lights, x, x.n, 0, c);
                REQUIRE(c.size == static_cast<int>(scene.lights.size()));
                for (int i = 0; i < c.size; i++) REQUIRE(c.inclusion[i] == 1);
            }
        }
    }

    TEST_CASE("teeth: a wrong number of candidates moves the mean, a wrong target does not") {
        Scene scene = three_lights(paint);
        ch15::Lights honest = ch15::prepare(scene, 2), wrong = honest, silly = honest;
        for (float& candidates : wrong.candidates) candidates *= 1.1f;
        silly.bounds[0].power *= 30;
        silly.bounds[2].power /= 30;
        auto mean_with = [&](const ch15::Lights& lights, uint32_t seed) {
            RunningStats s =
                repeat(scene, onto_origin, method_of<ch15::trace>(lights), 200000, seed);
            return std::pair(s.mean(), s.standard_error());
        };
        auto truth = mean_with(honest, 1);
        auto z_of = [&](std::pair<double, double> other) {
            return z_between({truth.first, truth.second}, {other.first, other.second});
        };
        CHECK(z_of(mean_with(wrong, 2)) > 5);
        CHECK(z_of(mean_with(silly, 3)) < 5);
    }

    TEST_CASE("failure: no light gives anything: no candidate") {
        Scene scene = three_lights(paint);
        for (Light& light : scene.lights) light.L = {};
        ch15::Candidates c;
        Hit x = origin_of(scene);
        ch15::choose_candidates(scene, ch15::prepare(scene), x, x.n, 0, c);
        CHECK(c.size == 0);
    }

    TEST_CASE("failure: targets beyond float: a sample that is seen, not a wrong one") {
        Scene scene = three_lights(paint);
        for (Light& light : scene.lights) light.L = {2e38f, 2e38f, 2e38f};
        ch15::Lights lights = ch15::prepare(scene);
        Sampler random = random_numbers(1);
        Recorder recorder;
        CHECK(!is_finite(ch15::trace(scene, lights, onto_origin, random, recorder)));
    }
}

TEST_SUITE("ch15 mis ris") {
    TEST_CASE("truth: irradiance of all lights" * doctest::skip()) {
        for (const auto& [light, E] : lights_of_known_irradiance) {
            Scene scene = floor_under(light);
            for (int M : {1, 2, 64})
                check_bounded(irradiance(scene, by_fifteen(scene, M), 20000), E, 0.025);
        }
    }

    TEST_CASE("identity: three lights give the sum of what each gives alone" * doctest::skip()) {
        for (const std::string& material : {paint, metal}) {
            CAPTURE(material);
            Scene scene = three_lights(material);
            double sum = 0, variance = 0;
            for (size_t i = 0; i < 3; i++) {
                Scene one = scene;
                for (size_t k = 0; k < 3; k++) one.lights[k].L *= k == i ? 1.0f : 0.0f;
                RunningStats s = repeat(one, onto_origin, by_fourteen(one), 100000, 1);
                sum += s.mean(), variance += s.standard_error() * s.standard_error();
            }
            for (int M : {1, 2, 64}) {
                CAPTURE(M);
                RunningStats s = repeat(scene, onto_origin, by_fifteen(scene, M), 100000, 2);
                CHECK(z_between({sum, std::sqrt(variance)}, {s.mean(), s.standard_error()}) < 5);
                CHECK(s.standard_error() < 0.02 * sum);
            }
        }
    }

    TEST_CASE("agreement: pictures, lengths and classes of paths with chapter 12") {
        for (const auto& [name, least] :
             std::vector<std::pair<std::string, int>>{{"cornell", 6},
                                                      {"cornell-spheres", 8},
                                                      {"two-lights", 4},
                                                      {"far-and-near", 2},
                                                      {"color-bleeding", 6},
                                                      {"thousand-lights", 4},
                                                      {"near-light", 2},
                                                      {"light-in-glass", 4},
                                                      {"horizon-sky", 2}}) {
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

    TEST_CASE("agreement: behind a wall, classes of paths with chapter 14") {
        Scene scene = scene_from("scenes/hidden-light.pbrt", 32, 8);
        CHECK(check_classes(scene, by_fourteen(scene), scene, by_fifteen(scene), 100000) >= 4);
    }

    TEST_CASE(
        "variance: a thousand lights over rough metal: lobes that turn away are not sampled") {
        // Without lobe_share() it was 5 times as much.
        Scene scene = scene_from("scenes/thousand-lights.pbrt", 48, 1);
        Material& floor = scene.materials[scene.shapes[0].material];
        REQUIRE(floor.reflectance.r == 0.6f);
        floor.type = MaterialType::conductor, floor.alpha = 0.2f;
        floor.eta = {0.2f, 0.2f, 0.2f}, floor.k = {3, 3, 3};
        double e = rel_mse(film_of(scene, by_fifteen(scene), 16).film);
        CHECK(e < 1);
    }

    TEST_CASE("variance: a thousand lights: a third of the relMSE of chapter 12") {
        Scene scene = scene_from("scenes/thousand-lights.pbrt", 64, 8);
        double twelve = rel_mse(film_of(scene, by_twelve(scene), 16).film);
        double fifteen = rel_mse(film_of(scene, by_fifteen(scene), 16).film);
        CHECK(fifteen < twelve / 3);
    }

    TEST_CASE("variance: a bright light behind a wall: both lights are sampled") {
        Scene scene = scene_from("scenes/hidden-light.pbrt", 32, 8);
        double twelve = rel_mse(film_of(scene, by_twelve(scene), 64).film);
        double fifteen = rel_mse(film_of(scene, by_fifteen(scene), 64).film);
        CHECK(fifteen < twelve / 10);
    }
}

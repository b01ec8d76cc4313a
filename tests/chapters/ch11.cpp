// Chapter 11: light importance: the alias table, powers, and where power misleads.
#include <doctest/doctest.h>

#include <array>

#include "chapters/10_cosine_sampling/estimator.h"
#include "chapters/11_light_importance/estimator.h"
#include "common/light/pdf_one_light.h"
#include "tests/support/estimators.h"

namespace {

constexpr float below_one = 0x1.fffffep-1f;

/// What the columns of the table give each light: the sum of their shares.
std::vector<double> pmf_of(const ch11::LightTable& table) {
    std::vector<double> pmf(table.size());
    double width = 1 / static_cast<double>(table.size());
    for (size_t i = 0; i < table.size(); i++) {
        pmf[i] += width * static_cast<double>(table[i].own);
        pmf[table[i].other] += width * (1 - static_cast<double>(table[i].own));
    }
    return pmf;
}

std::vector<double> normalized(std::vector<double> weights) {
    double sum = 0;
    for (double w : weights) sum += w;
    for (double& w : weights) w /= sum;
    return weights;
}

std::vector<double> random_pmf(size_t n, Sampler& random, bool skewed) {
    std::vector<double> weights;
    for (size_t i = 0; i < n; i++) {
        double u = static_cast<double>(random.u1());
        weights.push_back(skewed ? std::pow(1e-8, u) : u);
    }
    return normalized(weights);
}

/// Relative variance of one light out of these contributions, chosen by pmf.
double relative_variance(const std::vector<double>& f, const std::vector<double>& pmf) {
    double sum = 0, squares = 0;
    for (size_t i = 0; i < f.size(); i++) sum += f[i], squares += f[i] * f[i] / pmf[i];
    return squares / (sum * sum) - 1;
}

/// Two point lights straight up: 1000 times the power from 1000 m, and one from 1 m.
Scene far_and_near() {
    return floor_under(
        "LightSource \"point\" \"float scale\" 1000 \"point3 from\" [0 1000 0]\n"
        "LightSource \"point\" \"point3 from\" [0 1 0]");
}

/// Chapter 11 in this scene.
Method trace_11(const Scene& scene) { return method_of<ch11::trace>(ch11::prepare(scene)); }

}  // namespace

TEST_SUITE("ch11 light table") {
    TEST_CASE("identity: the alias table keeps every pmf") {
        Sampler random = random_numbers(1);
        for (size_t n : {1u, 2u, 3u, 7u, 100u, 1000u})
            for (bool skewed : {false, true}) {
                std::vector<double> pmf = random_pmf(n, random, skewed);
                auto table = ch11::build_light_table(pmf);
                std::vector<double> kept = pmf_of(table);
                for (size_t i = 0; i < n; i++) {
                    CHECK(table[i].own >= 0);
                    CHECK(table[i].own <= 1);
                    CHECK(std::abs(kept[i] - pmf[i]) < 1e-6);
                    CHECK(static_cast<double>(table[i].pmf) ==
                          doctest::Approx(pmf[i]).epsilon(1e-6).scale(0));
                }
            }
    }

    TEST_CASE("identity: over all 2^24 random numbers each light gets its share") {
        Sampler random = random_numbers(2);
        std::vector<double> pmf = random_pmf(100, random, true);
        ch11::LightTable table = ch11::build_light_table(pmf);
        std::vector<double> counts(pmf.size());
        for (uint32_t i = 0; i < 1u << 24; i++)
            counts[ch11::pick_light(table, static_cast<float>(i) * 0x1p-24f)]++;
        for (size_t i = 0; i < pmf.size(); i++)  // each column rounds by one number at most
            CHECK(std::abs(counts[i] * 0x1p-24 - pmf[i]) < 1e-5);
    }

    TEST_CASE("failure: a light of probability 0 is never chosen, not by 0 and not by rounding") {
        for (const std::vector<double>& pmf :
             std::vector<std::vector<double>>{{0, 0.3, 0.7, 0},
                                              {0, 1},
                                              {1, 0},
                                              {0, 0, 0.5, 0, 0.5, 0, 0},
                                              {1e-12, 0, 1 - 1e-12}}) {
            ch11::LightTable table = ch11::build_light_table(pmf);
            for (uint32_t i = 0; i < 4096; i++)
                CHECK(pmf[ch11::pick_light(table, static_cast<float>(i) / 4096)] > 0);
            for (float u : {0.0f, 0x1p-24f, below_one, 0.5f, std::nextafter(0.5f, 0.0f)})
                CHECK(pmf[ch11::pick_light(table, u)] > 0);
        }
    }

    TEST_CASE("truth: powers of lights") {
        auto power = [](const std::string& light) {
            Scene scene = floor_under(light);
            return static_cast<double>(ch11::light_power(scene, 0));
        };
        auto is = [](double x) { return doctest::Approx(x).epsilon(1e-5).scale(0); };
        CHECK(power(shining + square(1, false)) == is(4 * pi_exact));
        CHECK(power("AreaLightSource \"diffuse\" \"rgb L\" [1 2 6] " + square(1, false)) ==
              is(12 * pi_exact));
        CHECK(power("AreaLightSource \"diffuse\" \"bool twosided\" true " + square(1, false)) ==
              is(8 * pi_exact));
        CHECK(power("AreaLightSource \"diffuse\" \"float power\" 5 Shape \"sphere\"") == is(5));
        CHECK(power("LightSource \"point\" \"float power\" 100") == is(100));
        // A sky or sun shines through the disk of the scene's radius; from all sides, or one.
        double R = 500 * std::sqrt(2.0);
        CHECK(power("LightSource \"infinite\"") == is(4 * pi_exact * pi_exact * R * R));
        CHECK(power("LightSource \"distant\"") == is(pi_exact * R * R));
    }

    TEST_CASE("identity: probabilities sum to 1, and none is below its share d / N") {
        std::string lights;
        for (int i = 0; i < 40; i++)
            lights += "LightSource \"point\" \"point3 from\" [0 1 0] \"float scale\" " +
                      std::to_string(std::pow(10, i % 9)) + "\n";
        Scene scene = floor_under(lights);
        for (double d : {0.0, 0.25, 1.0}) {
            double sum = 0;
            for (double p : ch11::light_pmf(scene, d)) {
                CHECK(p >= d / 40);
                sum += p;
            }
            CHECK(sum == doctest::Approx(1).epsilon(1e-9).scale(0));
        }
        for (Light& light : scene.lights) light.L = {};
        for (double p : ch11::light_pmf(scene, 0)) CHECK(p == 1.0 / 40);
    }

    TEST_CASE("density: lights are chosen by their power, and pdf_w has the choice in it") {
        std::string lights;
        for (int i = 0; i < 10; i++)
            lights +=
                "AttributeBegin Material \"diffuse\" \"rgb reflectance\" [0 0 0]"
                " AreaLightSource \"diffuse\" \"float scale\" " +
                std::to_string(i + 1) + " " + unit_square(9, 2 * i) + " AttributeEnd\n";
        Scene scene = floor_under(lights);
        ch11::LightTable table = ch11::prepare(scene);
        Hit x = origin_of(scene);
        std::array<double, 10> counts{}, expected{};
        for (size_t i = 0; i < 10; i++)
            expected[i] = 100000 * (0.75 * static_cast<double>(i + 1) / 55 + 0.25 / 10);
        Sampler random = random_numbers(1);
        for (int i = 0; i < 100000; i++) {
            float u1 = random.u1();
            LightSample y = ch11::sample_light(scene, table, x, u1, random.u2());
            REQUIRE(y.pdf_w > 0);
            size_t light = static_cast<size_t>(std::lround(y.Le.g)) - 1;
            counts[light]++;
            if (i >= 100) continue;
            Hit hit = *intersect(scene, spawn_ray(x, y.wi));
            double pdf_one = static_cast<double>(pdf_one_light(scene, light, x, hit));
            CHECK(static_cast<double>(y.pdf_w) ==
                  doctest::Approx(expected[light] / 100000 * pdf_one).epsilon(1e-4).scale(0));
        }
        CHECK(chi_square_tail(chi_square(counts, expected), 9) > 1e-6);
    }
}

TEST_SUITE("ch11 light importance") {
    TEST_CASE("truth: far bright and near weak: power 998, all alike 0.996, half of each 2.98") {
        Scene scene = far_and_near();
        std::vector<double> f = {1000 / 1e6, 1};
        for (auto [d, relative] :
             {std::pair{0.0, 998.001}, {1.0, 0.996007988016}, {0.5, 2.98405317204}})
            CHECK(relative_variance(f, ch11::light_pmf(scene, d)) ==
                  doctest::Approx(relative).epsilon(1e-5).scale(0));
    }

    TEST_CASE("variance: the chapter's d bounds it by N / d, and the measured one agrees") {
        Scene scene = far_and_near();
        std::vector<double> f = {1000 / 1e6, 1}, pmf = ch11::light_pmf(scene, 0.25);
        double relative = relative_variance(f, pmf), E = f[0] + f[1], p = pmf[1];
        CHECK(relative < 2 / 0.25);
        RunningStats s = irradiance(scene, trace_11(scene), 100000);
        check_mean(s, E, relative * E * E, 0.1);
        check_variance(s, relative * E * E, (1 - 3 * p * (1 - p)) / (p * (1 - p)));
    }

    TEST_CASE("truth: two lights that give the same: 25 % and 75 % is worse than all alike") {
        Scene scene = floor_under(
            "LightSource \"point\" \"point3 from\" [0 1 0]\n"
            "LightSource \"point\" \"point3 from\" [0 1 0]");
        for (auto [p, variance] : {std::pair{0.5, 0.0}, {0.25, 4.0 / 3}}) {
            auto table = ch11::build_light_table({p, 1 - p});
            RunningStats s = irradiance(scene, method_of<ch11::trace>(table), 100000);
            check_mean(s, 2, variance + 1e-8, 0.05);
            if (variance > 0) check_variance(s, variance, (1 - 3 * p * (1 - p)) / (p * (1 - p)));
        }
    }

    TEST_CASE("failure: a light of one colour alone is not forgotten") {
        Scene scene = floor_under(
            "LightSource \"point\" \"point3 from\" [0 1 0] \"rgb I\" [0 0 1]\n"
            "LightSource \"point\" \"point3 from\" [0 1 0] \"rgb I\" [1 0 0]");
        Method trace = trace_11(scene);
        Sampler sampler(SamplerType::independent, 1, 1);
        Recorder recorder;
        RunningStats blue;
        for (uint32_t i = 0; i < 40000; i++) {
            sampler.start(0, i);
            blue.add(pi_exact * double{trace(scene, onto_origin, sampler, recorder).b});
        }
        check_mean(blue, 1, 1, 0.05);
        CHECK(blue.variance() == doctest::Approx(1).epsilon(1e-4).scale(0));
    }

    TEST_CASE("agreement: pictures, lengths and classes of paths with chapter 10" *
              doctest::skip()) {
        for (const auto& [name, least] :
             std::vector<std::pair<std::string, int>>{{"cornell", 6},
                                                      {"two-lights", 4},
                                                      {"far-and-near", 2},
                                                      {"hidden-light", 6},
                                                      {"thousand-lights", 4},
                                                      {"near-light", 2},
                                                      {"horizon-sky", 2}}) {
            Scene scene = scene_from("scenes/" + name + ".pbrt", 32, 8);
            CHECK(check_classes(scene, ch10::trace, scene, trace_11(scene), 40000) >= least);
        }
        Scene scene = scene_from("scenes/two-lights.pbrt", 32, 8);
        check_agreement(hold_against(film_of(scene, ch10::trace, 128).film,
                                     film_of(scene, trace_11(scene), 128, 2).film),
                        0.005);
    }

    TEST_CASE("variance: a thousand lights: a third of the relMSE of chapter 10") {
        Scene scene = scene_from("scenes/thousand-lights.pbrt", 32, 8);
        double before = rel_mse(film_of(scene, ch10::trace, 256).film);
        double now = rel_mse(film_of(scene, trace_11(scene), 256).film);
        CHECK(now < before / 3);
    }

    TEST_CASE("failure: where the bright light is far or hidden, worse than chapter 10") {
        for (std::string name : {"far-and-near", "hidden-light"}) {
            CAPTURE(name);
            Scene scene = scene_from("scenes/" + name + ".pbrt", 32, 8);
            double before = rel_mse(film_of(scene, ch10::trace, 128).film);
            double now = rel_mse(film_of(scene, trace_11(scene), 128).film);
            CHECK(now > 1.2 * before);
            CHECK(now < 8.5 * before);  // but not by more than N / d
        }
    }
}

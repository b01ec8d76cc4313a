// Chapter 14: the weights of multiple importance sampling, and all strategies.
#include <doctest/doctest.h>

#include "chapters/10_cosine_sampling/estimator.h"
#include "chapters/13_glossy/estimator.h"
#include "chapters/14_mis/estimator.h"
#include "tests/support/known_lights.h"
#include "tests/support/plates.h"

using ch14::balance_heuristic, ch14::power_heuristic;

namespace {

using Heuristic = float (*)(float a, float b);

/// Either way alone, which is chapter 13; or both.
enum class Strategy { bsdf, light, mis };
constexpr Strategy all_strategies[] = {Strategy::bsdf, Strategy::light, Strategy::mis};
struct Choice {
    Strategy strategy = Strategy::mis;
    Heuristic heuristic = power_heuristic;
};
Method by(Choice choice, const Scene& scene) {
    LightTable lights = ch13::prepare(scene);
    if (choice.strategy == Strategy::bsdf)
        return method_of<ch13::trace>(lights, ch13::Strategy::bsdf);
    if (choice.strategy == Strategy::light)
        return method_of<ch13::trace>(lights, ch13::Strategy::light);
    return method_of<ch14::trace>(ch14::prepare(scene, choice.heuristic));
}

constexpr Heuristic both_heuristics[] = {balance_heuristic, power_heuristic};

/// The heuristic, in double.
double weight(Heuristic heuristic, double a, double b) {
    return static_cast<double>(heuristic(static_cast<float>(a), static_cast<float>(b)));
}

/// x^2 or another integrand on [0,1], one sample of each of two densities: MIS as in the chapter.
struct Line {
    double (*f)(double);
    double (*p1)(double), (*p2)(double);
    double (*sample1)(double), (*sample2)(double);

    double first(Heuristic heuristic, double u) const {
        double x = sample1(u);
        return f(x) / p1(x) * weight(heuristic, p1(x), p2(x));
    }
    double second(Heuristic heuristic, double u) const {
        double x = sample2(u);
        return f(x) / p2(x) * weight(heuristic, p2(x), p1(x));
    }
    RunningStats both(Heuristic heuristic, int samples) const {
        RunningStats stats;
        Sampler random = random_numbers(1);
        for (int i = 0; i < samples; i++) {
            double u1 = static_cast<double>(random.u1()), u2 = static_cast<double>(random.u1());
            stats.add(first(heuristic, u1) + second(heuristic, u2));
        }
        return stats;
    }
    RunningStats one(Heuristic heuristic, int samples) const {
        RunningStats stats;
        Sampler random = random_numbers(1);
        for (int i = 0; i < samples; i++) {
            double u = static_cast<double>(random.u1());
            bool is_first = random.u1() < 0.5f;
            stats.add(2 * (is_first ? first(heuristic, u) : second(heuristic, u)));
        }
        return stats;
    }
};
const Line square_line = {[](double x) { return x * x; }, [](double) { return 1.0; },
                          [](double x) { return 2 * x; }, [](double u) { return u; },
                          [](double u) { return std::sqrt(u); }};
/// x^-1/2 + (1-x)^-1/2 = 2 (p1 + p2).
const Line two_poles = {[](double x) { return 1 / std::sqrt(x) + 1 / std::sqrt(1 - x); },
                        [](double x) { return 0.5 / std::sqrt(x); },
                        [](double x) { return 0.5 / std::sqrt(1 - x); },
                        [](double u) { return std::pow(u * (1 - 1e-6) + 5e-7, 2); },
                        [](double u) { return 1 - std::pow(u * (1 - 1e-6) + 5e-7, 2); }};
/// The second density sees the left half only.
const Line half_line = {[](double x) { return x * x; }, [](double) { return 1.0; },
                        [](double x) { return x < 0.5 ? 2.0 : 0.0; }, [](double u) { return u; },
                        [](double u) { return u / 2; }};

}  // namespace

TEST_SUITE("ch14 weights") {
    TEST_CASE("identity: MIS weights sum to 1") {
        std::vector<std::pair<float, float>> table = {
            {1, 2},          {0, 5},           {3e19f, 1},        {3e19f, 3e19f}, {1e-23f, 1e-24f},
            {3e38f, 1e-38f}, {3e38f, 3e38f},   {1e-38f, 1e-38f},  {infinity, 1},  {infinity, 0},
            {0, 1e-45f},     {1e-45f, 1e-40f}, {1e-23f, infinity}};
        Sampler random = random_numbers(1);
        for (int i = 0; i < 10000; i++) {
            float a = std::pow(10.0f, 20 * random.u1() - 10);
            table.push_back({a, std::pow(10.0f, 20 * random.u1() - 10)});
        }
        for (Heuristic heuristic : both_heuristics)
            for (auto [a_here, b_here] : table) {
                float a = a_here, b = b_here;
                CAPTURE(a);
                CAPTURE(b);
                // What has density 0 draws nothing.
                float of_a = a > 0 ? heuristic(a, b) : 0, of_b = b > 0 ? heuristic(b, a) : 0;
                CHECK(of_a >= 0);
                CHECK(of_b >= 0);
                CHECK(of_a + of_b == doctest::Approx(1).epsilon(1e-6).scale(0));
            }
    }

    TEST_CASE("truth: the weights are a / (a + b) and a^2 / (a^2 + b^2)") {
        Sampler random = random_numbers(1);
        for (int i = 0; i < 1000; i++) {
            float a = random.u1() + 0.01f, b = 3 * random.u1();
            double x{a}, y{b};
            CHECK(balance_heuristic(a, b) == doctest::Approx(x / (x + y)).epsilon(1e-6).scale(0));
            CHECK(power_heuristic(a, b) ==
                  doctest::Approx(x * x / (x * x + y * y)).epsilon(1e-6).scale(0));
        }
    }

    TEST_CASE("failure: p^2 / (p^2 + q^2) is NaN for large and for small densities") {
        auto naive = [](float a, float b) { return a * a / (a * a + b * b); };
        CHECK(std::isnan(naive(3e19f, 1)));
        CHECK(std::isnan(naive(1e-23f, 1e-24f)));
        CHECK(power_heuristic(3e19f, 1) == 1);
        CHECK(power_heuristic(1e-23f, 1e-24f) == doctest::Approx(1 / 1.01).epsilon(1e-6).scale(0));
    }

    TEST_CASE("truth: MIS in one dimension") {
        struct Row {
            const Line& line;
            Heuristic heuristic;
            double mean, variance;
        };
        for (auto [line, heuristic, mean, variance] :
             {Row{square_line, balance_heuristic, 1.0 / 3, 0.01872105860672},
              {square_line, power_heuristic, 1.0 / 3, 0.01817598677553},
              {two_poles, power_heuristic, 4, 8.0 / 15},
              {half_line, balance_heuristic, 1.0 / 3, 0.1016975308642}}) {
            RunningStats s = line.both(heuristic, 400000);
            check_mean(s, mean, variance, 0.01 * mean + 0.01);
            check_variance(s, variance, 4);
        }
    }

    TEST_CASE("truth: one sample by a coin is the mixture of both densities: variance 0.04089") {
        RunningStats s = square_line.one(balance_heuristic, 400000);
        check_mean(s, 1.0 / 3, 0.04088549026398, 0.01);
        check_variance(s, 0.04088549026398, 3);
        CHECK(s.variance() > 2 * 0.01872105860672);  // one of each is better than half of two
    }

    TEST_CASE("identity: where f is the sum of both densities, every pair of samples is exact") {
        // Each density alone has infinite variance.
        RunningStats both = two_poles.both(balance_heuristic, 10000);
        RunningStats one = two_poles.one(balance_heuristic, 10000);
        CHECK(both.mean() == doctest::Approx(4).epsilon(1e-5).scale(0));
        CHECK(std::sqrt(both.variance()) < 1e-5);
        CHECK(std::sqrt(one.variance()) < 1e-5);
    }

    TEST_CASE("failure: a density per area beside one per solid angle: 0.881, 1.105, 1.318") {
        // The light's samples weigh with the right density, the BSDF's with 1 / area.
        for (auto [h, wrong] :
             {std::pair{0.5, 0.8809532795696}, {1.0, 1.105316968821}, {2.0, 1.317990844865}}) {
            // Irradiance of the disk, over z = cos: 2 pi z dz from h / sqrt(1 + h^2) to 1.
            double low = h / std::sqrt(1 + h * h), right = 0, mixed = 0, both_wrong = 0;
            for (int i = 0; i < 10000; i++) {
                double z = low + (1 - low) * (i + 0.5) / 10000;
                double light = h * h / (z * z * z * pi_exact), raw = 1 / pi_exact;
                double bsdf = z / pi_exact;
                auto of_light = [&](double l) { return weight(balance_heuristic, l, bsdf); };
                auto of_bsdf = [&](double l) { return weight(balance_heuristic, bsdf, l); };
                right += z * (of_light(light) + of_bsdf(light));
                mixed += z * (of_light(light) + of_bsdf(raw));
                both_wrong += z * (of_light(raw) + of_bsdf(raw));
            }
            CHECK(mixed / right == doctest::Approx(wrong).epsilon(1e-4).scale(0));
            CHECK(both_wrong / right == doctest::Approx(1).epsilon(1e-6).scale(0));
        }
    }
}

TEST_SUITE("ch14 mis") {
    TEST_CASE("truth: irradiance of all lights, by every strategy") {
        for (const auto& [light, E] : lights_of_known_irradiance) {
            Scene scene = floor_under(light);
            for (Strategy strategy : all_strategies)
                for (Heuristic heuristic : both_heuristics) {
                    bool rare = strategy == Strategy::bsdf;
                    Method trace = by({strategy, heuristic}, scene);
                    check_bounded(irradiance(scene, trace, rare ? 60000 : 20000), E, 0.025);
                }
        }
    }

    TEST_CASE("truth: point and distant lights, which only light sampling finds: none is lost") {
        for (const auto& [light, E] : lights_without_size) {
            Scene scene = floor_under(light);
            for (Strategy strategy : {Strategy::light, Strategy::mis}) {
                RunningStats s = irradiance(scene, by({strategy}, scene), 100);
                CHECK(s.mean() == doctest::Approx(E).epsilon(1e-5).scale(0));
                CHECK(s.variance() < 1e-10);
            }
        }
    }

    TEST_CASE("truth: a light in a mirror and straight on, by every strategy, without noise") {
        Scene mirror = light_before_mirror();
        for (Strategy strategy : all_strategies)
            check_light_before_mirror(mirror, by({strategy}, mirror));
    }

    TEST_CASE("variance: a sky at the horizon: less relMSE than in chapter 10") {
        Scene scene = scene_from("scenes/horizon-sky.pbrt", 32, 8);
        Film ten = film_of(scene, ch10::trace, 512).film;
        Film both = film_of(scene, by({}, scene), 256, 2).film;
        CHECK(rel_mse(both) < rel_mse(ten) * 2 / 3);
        check_agreement(hold_against(ten, both), 0.02);
    }

    TEST_CASE("agreement: pictures, lengths and classes of paths with chapter 13") {
        for (const auto& [name, least] :
             std::vector<std::pair<std::string, int>>{{"cornell", 6},
                                                      {"cornell-spheres", 8},
                                                      {"two-lights", 4},
                                                      {"far-and-near", 2},
                                                      {"color-bleeding", 6},
                                                      {"thousand-lights", 4},
                                                      {"near-light", 2},
                                                      {"light-in-glass", 4},
                                                      {"horizon-sky", 2},
                                                      {"veach-mis", 6}}) {
            Scene scene = scene_from("scenes/" + name + ".pbrt", 32, 8);
            Method aimed = method_of<ch13::trace>(ch13::prepare(scene), ch13::Strategy::light);
            CHECK(check_classes(scene, aimed, scene, by({}, scene), 20000) >= least);
        }
    }

    TEST_CASE("agreement: each weight belongs to the last vertex, also after several") {
        for (const std::string& board : boards) {
            Scene scene = board_beside_lamp(board);
            Method light = by({Strategy::light}, scene);
            CHECK(check_classes(scene, light, scene, by({}, scene), 200000) >= 6);
        }
    }

    TEST_CASE("agreement: classes of path by each strategy on Veach's plates") {
        Scene scene = scene_from("scenes/veach-mis.pbrt", 32, 6);
        PathCensus mis = census_of(scene, by({}, scene), 60000, 1);
        for (Strategy strategy : {Strategy::bsdf, Strategy::light}) {
            PathCensus census = census_of(scene, by({strategy}, scene), 100000, 2);
            CHECK(census.worst_sum < 1e-5);
            for (auto& [name, part] : mis.by_class) {
                if (part.not_zero < 200 || census.by_class[name].not_zero < 200) continue;
                CHECK(z_between(part.measured(mis.paths),
                                census.by_class[name].measured(census.paths)) < 5);
            }
        }
    }
}

TEST_SUITE("ch14 plates") {
    TEST_CASE("variance: each plate and lamp: the better way's, and at most half a squared mean" *
              doctest::skip()) {
        // Balance heuristic, one sample of each: Var <= Var of either + mean^2 / 2. Veach 1997, 9.2
        for (size_t plate = 0; plate < 4; plate++)
            for (size_t lamp = 0; lamp < 4; lamp++) {
                CAPTURE(plate);
                CAPTURE(lamp);
                PlateAndLamp view(plate, lamp);
                auto variance = [&](Choice choice) {
                    return relative_variance(view.sample(by(choice, view.scene), 40000));
                };
                double better = std::min(variance({Strategy::bsdf}), variance({Strategy::light}));
                CHECK(variance({Strategy::mis, balance_heuristic}) < better + 0.5);
                CHECK(variance({Strategy::mis, power_heuristic}) < better + 0.5);
                CHECK(variance({Strategy::mis, power_heuristic}) < 0.3);
            }
    }
}

// Chapter 08: Russian roulette: the mean of chapter 07, its price, and what a wrong one does.
#include <doctest/doctest.h>

#include "chapters/07_path_tracing/estimator.h"
#include "chapters/08_russian_roulette/estimator.h"
#include "tests/support/estimators.h"

namespace {

const Method trace_07 = method_of<ch07::trace>(), trace_08 = method_of<ch08::trace>();

/// The red channel of a path in a closed sphere that emits 1 and reflects (0.9, 0.1, 0.1), drawn in
/// proportion to the cosine: every bounce is worth that. `survival` is asked as chapter 08 asks it.
template <class Survival>
RunningStats red_furnace(const Survival& survival, int paths) {
    RunningStats stats;
    Sampler random = random_numbers(1);
    for (int i = 0; i < paths; i++) {
        Rgb beta = {1, 1, 1};
        double red = 1;
        for (int depth = 0;; depth++) {
            beta *= Rgb{0.9f, 0.1f, 0.1f};
            float q = survival(beta, depth);
            if (random.u1() >= q) break;
            beta /= q;
            red += static_cast<double>(beta.r);
        }
        stats.add(red);
    }
    return stats;
}

/// The same, exactly. Three bounces bring 0.9 + 0.9^2 + 0.9^3. The fourth survives with 0.9^4, each
/// one after it with 0.9, and each is then worth 1: k of them with probability 0.9^4 0.9^(k-1) 0.1.
struct Moments {
    double mean = 0, variance = 0, kurtosis = 0;
};
Moments red_moments() {
    auto expected = [](const auto& f) {
        double sum = (1 - std::pow(0.9, 4)) * f(0);
        for (int k = 1; k < 1000; k++) sum += std::pow(0.9, k + 3) * 0.1 * f(k);
        return sum;
    };
    Moments red;
    red.mean = expected([](double k) { return 1 + 0.9 + 0.81 + 0.729 + k; });
    auto power = [&](int n) {
        return expected([&](double k) { return std::pow(3.439 + k - red.mean, n); });
    };
    red.variance = power(2), red.kurtosis = power(4) / (power(2) * power(2));
    return red;
}

}  // namespace

TEST_SUITE("ch08 roulette") {
    TEST_CASE("identity: q is a probability, at least 0.05, and 1 for short paths") {
        Sampler random = random_numbers(1);
        for (int i = 0; i < 10000; i++) {
            float size = std::pow(10.0f, 4 * random.u1() - 3);
            Rgb beta = {size * random.u1(), size * random.u1(), size * random.u1()};
            for (int depth : {0, 1, 2}) CHECK(ch08::survival_probability(beta, depth) == 1);
            float q = ch08::survival_probability(beta, 3 + i % 50);
            CHECK(q >= 0.05f);
            CHECK(q <= 1);
            // No channel grows.
            CHECK(max_component(beta / q) <= std::max(1.0f, max_component(beta)) * 1.000001f);
        }
        CHECK(ch08::survival_probability({0, 0, 0}, 10) == 0.05f);
        // Only the depth limit ends paths that lose nothing.
        CHECK(ch08::survival_probability({0, 1, 0}, 10) == 1);
    }

    TEST_CASE("truth: with colours, q from the largest channel keeps the variance of red finite") {
        Moments red = red_moments();
        CHECK(red.mean == nearly(10));
        CHECK(red.variance == nearly(81.612279));
        RunningStats s = red_furnace(ch08::survival_probability, 200000);
        check_mean(s, red.mean, red.variance, 0.2);
        check_variance(s, red.variance, red.kurtosis);
    }

    TEST_CASE("teeth: q from the mean of the channels makes the red of survivors 3, not 1") {
        auto from_mean = [](Rgb beta, int depth) {
            return depth < 3 ? 1 : std::clamp(average(beta), 0.05f, 1.0f);
        };
        // After some bounces beta is nearly pure red, and its mean is a third of red.
        Rgb beta = {0.3f, 1e-4f, 1e-4f};
        CHECK((beta / from_mean(beta, 5)).r > 2.9f);
        CHECK((beta / ch08::survival_probability(beta, 5)).r == 1);
        double variance = red_furnace(from_mean, 200000).variance();  // exactly: 330.918
        Moments red = red_moments();
        CHECK(variance / red.variance - 1 > 5 * std::sqrt(red.kurtosis / 200000));
        CHECK(variance > 2 * red.variance);
    }
}

TEST_SUITE("ch08 russian roulette") {
    TEST_CASE("truth: inside a closed sphere: Le / (1 - a)") {
        for (double a : {0.5, 0.8}) {
            Rendering r = film_of(closed_sphere(a, 100000), trace_08, 100);
            CHECK(r.stats.paths_cut == 0);
            CHECK(std::abs(r.film.mean() * (1 - a) - 1) < 5 * r.film.standard_error() * (1 - a));
            CHECK(r.film.standard_error() * (1 - a) < 0.01);
        }
        // Without the division by q each bounce counts a q: 2.78 instead of 5, for a = q = 0.8.
        CHECK(1 / (1 - 0.8 * 0.8) == nearly(2.78, 1e-3));
    }

    TEST_CASE("variance: fewer rays for about the same error") {
        Scene scene = scene_from("scenes/cornell.pbrt", 32, 100);
        Rendering a = film_of(scene, trace_07, 256), b = film_of(scene, trace_08, 256);
        CHECK(z_between({a.film.mean(), a.film.standard_error()},
                        {b.film.mean(), b.film.standard_error()}) < 5);
        auto cost = [](const Rendering& r) {  // relative variance of the mean, times rays
            double e = r.film.standard_error() / r.film.mean();
            return e * e * static_cast<double>(r.stats.rays);
        };
        CHECK(static_cast<double>(b.stats.rays) < 0.6 * static_cast<double>(a.stats.rays));
        CHECK(cost(b) < 0.7 * cost(a));
    }
}

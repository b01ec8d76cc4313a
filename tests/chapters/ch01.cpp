// Chapter 01: darts, their standard error, the dart board, and sums in float.
#include <doctest/doctest.h>

#include <array>
#include <utility>

#include "chapters/01_monte_carlo_pi/figure.h"
#include "tests/support/gates.h"

namespace {

constexpr double dart_variance = pi_exact * (4 - pi_exact);
constexpr double dart_kurtosis = 2.933031911061;

double score_hit(Vec2 u) { return ch01::score_board(ch01::sample_hit(u)); }

/// The gates are written for the RunningStats of common/, which are these.
RunningStats throw_darts(double (*score)(Vec2), uint64_t n, uint32_t seed) {
    RunningStats stats;
    ch01::throw_darts(
        [&](Vec2 u) {
            stats.add(score(u));
            return 0;
        },
        0, n, seed);
    return stats;
}

/// chi^2 of hits in 8 x 8 cells on [-1.5, 1.5]^2 and the rest of the plane against pdf_hit.
template <class Sample>
double chi_square_of_hits(Sample sample) {
    constexpr int cells = 8, fine = 32, n = 200000;
    auto cell = [](Vec2 x) {
        double i = std::floor((double{x.x} + 1.5) / 3 * cells);
        double j = std::floor((double{x.y} + 1.5) / 3 * cells);
        bool inside = i >= 0 && i < cells && j >= 0 && j < cells;
        return static_cast<size_t>(inside ? i * cells + j : cells * cells);
    };
    std::array<double, cells * cells + 1> counts{}, expected{};
    constexpr double step = 3.0 / (cells * fine);
    for (int i = 0; i < cells * fine; i++)
        for (int j = 0; j < cells * fine; j++) {
            Vec2 x{static_cast<float>(-1.5 + (i + 0.5) * step),
                   static_cast<float>(-1.5 + (j + 0.5) * step)};
            expected[cell(x)] += n * step * step * ch01::pdf_hit(x);
        }
    expected.back() = n;
    for (int c = 0; c < cells * cells; c++) expected.back() -= expected[static_cast<size_t>(c)];
    Sampler sampler(SamplerType::independent, 1, 1);
    for (uint32_t i = 0; i < n; i++) {
        sampler.start(0, i);
        counts[cell(sample(sampler.u2()))]++;
    }
    return chi_square(counts, expected);
}

}  // namespace

TEST_SUITE("ch01 monte carlo pi") {
    TEST_CASE("truth: mean and variance of a dart") {
        RunningStats s = throw_darts(ch01::score_dart, 1000000, 1);
        check_mean(s, pi_exact, dart_variance, 0.015);
        check_variance(s, dart_variance, dart_kurtosis);
        CHECK(s.standard_error() == nearly(0.00164218, 0.01));
    }

    TEST_CASE("variance: four times the darts, half the standard error") {
        double last = 0;
        for (uint64_t n : {64u, 256u, 1024u}) {
            double measured = ch01::measured_standard_error(ch01::score_dart, n, 4096, 1);
            double theory = std::sqrt(dart_variance / static_cast<double>(n));
            constexpr double gate = 5 / 90.5;  // relative error of s from 4096 runs: 1/sqrt(2 runs)
            CHECK(std::abs(measured / theory - 1) < gate);
            if (last > 0) CHECK(std::abs(last / measured - 2) < 2 * gate);
            last = measured;
        }
    }

    TEST_CASE("failure: darts that all score the same claim an error of 0, which is unknown") {
        ch01::RunningStats one = ch01::throw_darts(ch01::score_dart, 0, 1, 0);
        CHECK(one.standard_error() == 0);
        CHECK(std::abs(one.mean() - pi_exact) > 0.8);
        CHECK(ch01::darts_table(1, 0).rows[0][2] == "unknown");
    }

    TEST_CASE("identity: darts of separate ranges, merged, give the same as all at once") {
        RunningStats whole = throw_darts(ch01::score_dart, 1000, 3);  // of common/
        ch01::RunningStats a = ch01::throw_darts(ch01::score_dart, 0, 300, 3);
        a.merge(ch01::throw_darts(ch01::score_dart, 300, 1000, 3));
        CHECK(a.count() == 1000);
        CHECK(a.mean() == nearly(whole.mean(), 1e-14));
        CHECK(a.variance() == nearly(whole.variance(), 1e-12));
        CHECK(a.standard_error() == nearly(whole.standard_error(), 1e-12));
    }
}

TEST_SUITE("ch01 dart board") {
    TEST_CASE("density: hits of the dart board") {
        CHECK(chi_square_tail(chi_square_of_hits(ch01::sample_hit), 64) > 1e-6);
    }

    TEST_CASE("consistency: invert_hit finds the numbers that sample_hit used") {
        Sampler sampler(SamplerType::independent, 1, 1);
        for (uint32_t i = 0; i < 1000; i++) {
            sampler.start(0, i);
            Vec2 u = sampler.u2(), again = ch01::invert_hit(ch01::sample_hit(u));
            CHECK(std::abs(again.x - u.x) < 1e-6f);
            CHECK(std::abs(again.y - u.y) < 1e-6f);
        }
    }

    TEST_CASE("truth: the average score of the board") {
        // integral of f(x) p(x) over the plane, ring by ring, by the midpoint rule
        double integral = 0, square = 0, previous = 0;
        for (ch01::Ring ring : ch01::board) {
            constexpr int steps = 10000;
            for (int i = 0; i < steps; i++) {
                double width = (ring.radius - previous) / steps, r = previous + (i + 0.5) * width;
                double mass = 2 * pi_exact * r * width * ch01::pdf_hit({static_cast<float>(r), 0});
                integral += ring.score * mass;
                square += ring.score * ring.score * mass;
            }
            previous = ring.radius;
        }
        CHECK(ch01::expected_score() == nearly(integral, 1e-7));
        RunningStats s = throw_darts(score_hit, 1000000, 1);
        check_mean(s, ch01::expected_score(), square - integral * integral, 0.02);
    }
}

TEST_SUITE("ch01 sums in float") {
    TEST_CASE("failure: a float counter stops at 2^24") {
        CHECK(ch01::sum_in_float(1, (1 << 24) - 1) == 16777215);
        CHECK(ch01::sum_in_float(1, 1 << 24) == 16777216);
        CHECK(ch01::sum_in_float(1, 20000000) == 16777216);
    }
}

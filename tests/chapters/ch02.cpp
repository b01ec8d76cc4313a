// Chapter 02: strata by their exact variances, and their failures.
#include <doctest/doctest.h>

#include "chapters/02_stratification/figure.h"
#include "tests/support/points.h"

namespace {

using ch02::Points;
using ch02::PointSet;

constexpr PointSet all_sets[] = {PointSet::uniform, PointSet::jittered, PointSet::rooks};

/// Estimates by sets of n points.
auto by(PointSet set, uint32_t n) {
    return
        [=](uint32_t seed, auto f) { return ch02::estimate(ch02::make_points(set, n, seed), f); };
}

Points grid(uint32_t n) {  // the centres of n x n cells
    Points points;
    for (uint32_t i = 0; i < n * n; i++)
        points.push_back(ch02::jitter_in_stratum(i, n * n, {0.5f, 0.5f}));
    return points;
}

}  // namespace

TEST_SUITE("ch02 strata") {
    TEST_CASE("truth: points in strata are unbiased, for pi, for xy and for e^(x+y)") {
        for (PointSet set : all_sets)
            check_points([=](auto... n_and_seed) { return ch02::make_points(set, n_and_seed...); },
                         [](const Points& points, auto f) { return ch02::estimate(points, f); });
    }

    TEST_CASE("variance: 36 darts, uniform 0.0749, in 6 x 6 strata 0.0162") {
        RunningStats uniform = estimates(by(PointSet::uniform, 36), 20000, ch02::quarter_circle);
        RunningStats jittered = estimates(by(PointSet::jittered, 36), 20000, ch02::quarter_circle);
        check_variance(uniform, dart_variance / 36, 3);
        check_variance(jittered, 0.0162201310097, 3);
        CHECK(std::abs(uniform.variance() / jittered.variance() / 4.6183457178 - 1) < 0.07);
    }

    TEST_CASE("variance: for xy that of k x k strata falls as k^-4, N-rooks keep the interaction") {
        for (uint32_t n : {2u, 4u, 8u, 16u}) {
            double n2 = n * n, truth = 1 / (18 * n2 * n2) - 1 / (144 * n2 * n2 * n2);
            check_variance(estimates(by(PointSet::jittered, n * n), 10000, ch02::product), truth,
                           3);
        }
        // To first order in 1/N; N = 256 leaves the 5 % of the gate.
        RunningStats rooks = estimates(by(PointSet::rooks, 256), 10000, ch02::product);
        check_variance(rooks, 1.0 / 144 / 256, 3);
        RunningStats rooks_pi = estimates(by(PointSet::rooks, 256), 10000, ch02::quarter_circle);
        check_variance(rooks_pi, 1.102641682115 / 256, 3);
    }

    TEST_CASE("variance: N intervals on a line, N^-3 for x^2 and N^-2 for a step") {
        auto square = [](Vec2 p) { return double{p.x} * double{p.x}; };
        for (uint32_t n : {2u, 4u, 16u, 64u}) {
            double N = n, truth = 1 / (9 * N * N * N) - 1 / (45 * std::pow(N, 5));
            check_variance(estimates(by(PointSet::rooks, n), 10000, square), truth, 3);
        }
        auto step = [](Vec2 p) { return double{p.x} < 1 / pi_exact ? 1 : 0; };
        for (uint32_t n : {10u, 100u, 1000u}) {
            double a = n / pi_exact - std::floor(n / pi_exact), q = a * (1 - a);
            RunningStats s = estimates(by(PointSet::rooks, n), 5000, step);
            check_variance(s, q / n / n, (1 - 3 * q) / q);  // one cut interval: a coin
        }
    }

    TEST_CASE("failure: s^2/N is 4.7 times the variance of 6 x 6 strata") {
        RunningStats naive, batches;
        for (uint32_t run = 0; run < 5000; run++) {
            RunningStats set;
            for (Vec2 p : ch02::make_points(PointSet::jittered, 36, run))
                set.add(ch02::quarter_circle(p));
            naive.add(set.variance() / 36);
            batches.add(set.mean());
        }
        double truth = 0.0162201310097;
        CHECK(std::abs(naive.mean() / truth / 4.721727024024 - 1) < 0.02);
        CHECK(std::abs(batches.variance() / truth - 1) < 0.10);  // the spread of sets is honest
    }
}

TEST_SUITE("ch02 pictures and slopes") {
    TEST_CASE("truth: the penumbra of a straight edge") {
        CHECK(ch02::fraction_seen(-0.1) == 0);
        CHECK(ch02::fraction_seen(0) == 0);
        CHECK(ch02::fraction_seen(0.7) == nearly(0.5, 1e-14));
        CHECK(ch02::fraction_seen(1.4) == nearly(1, 1e-14));
        CHECK(ch02::fraction_seen(9) == nearly(1, 1e-12));
        for (double p : {0.1, 0.3, 0.65, 0.9, 1.3}) {
            Points points = grid(1000);
            double counted = ch02::estimate(points, [&](Vec2 u) { return ch02::sees_light(u, p); });
            CHECK(std::abs(ch02::fraction_seen(p) - counted) < 1e-4);
        }
    }

    TEST_CASE("variance: the error falls with the slope of theory") {
        auto check = [](PointSet set, const std::vector<double>& theory) {
            check_slopes([=](uint32_t n) { return ch02::measure(set, n, 400, 1); }, theory);
        };
        check(PointSet::uniform, {-0.5, -0.5, -0.5});
        check(PointSet::rooks, {-0.5, -0.5, -0.5});
        // pi: by the exact variances of 4 x 4 and 32 x 32 strata.
        check(PointSet::jittered, {-0.73, -1.0, -0.75});
    }
}

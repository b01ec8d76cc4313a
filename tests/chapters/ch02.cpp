// Chapter 02: strata by their exact variances, and their failures.
#include <doctest/doctest.h>

#include <algorithm>
#include <utility>

#include "chapters/02_stratification/figure.h"
#include "tests/support/gates.h"

namespace {

using ch02::Points;
using ch02::PointSet;

constexpr double pi_exact = std::numbers::pi;
constexpr double dart_variance = pi_exact * (4 - pi_exact);
constexpr PointSet all_sets[] = {PointSet::uniform, PointSet::jittered, PointSet::rooks};

double column(Vec2 p) { return double{p.x} * double{p.x}; }  // x^2, varies along x only
double exponential(Vec2 p) { return std::exp(double{p.x} + double{p.y}); }

/// Estimates of f from `runs` sets of points.
template <class Make, class Function>
RunningStats estimates(Make make, uint32_t runs, Function f) {
    RunningStats stats;
    for (uint32_t run = 0; run < runs; run++) stats.add(ch02::estimate(make(hash32(run, 2)), f));
    return stats;
}
template <class Function>
RunningStats estimates(PointSet set, uint32_t n, uint32_t runs, Function f) {
    return estimates([=](uint32_t seed) { return ch02::make_points(set, n, seed); }, runs, f);
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
        // The variance of free points bounds the gate: none of these sets is worse.
        double e = std::numbers::e;
        double exponential_variance = std::pow((e * e - 1) / 2, 2) - std::pow(e - 1, 4);
        for (PointSet set : all_sets)
            for (uint32_t n : {7u, 16u}) {
                RunningStats pi_estimate, product, sum;
                for (uint32_t run = 0; run < 2000; run++) {
                    Points points = ch02::make_points(set, n, hash32(run, 2));
                    pi_estimate.add(ch02::estimate(points, ch02::quarter_circle));
                    product.add(ch02::estimate(points, ch02::product));
                    sum.add(ch02::estimate(points, exponential));
                }
                check_mean(pi_estimate, pi_exact, dart_variance / n, 0.12);
                check_mean(product, 0.25, 7.0 / 144 / n, 0.02);
                check_mean(sum, (e - 1) * (e - 1), exponential_variance / n, 0.2);
            }
    }

    TEST_CASE("identity: any N gives N points on the square, and the average of 1 is exactly 1") {
        for (PointSet set : all_sets)
            for (uint32_t n = 1; n <= 200; n++) {
                Points points = ch02::make_points(set, n, n);
                CHECK(points.size() == n);
                bool inside = std::all_of(points.begin(), points.end(), [](Vec2 p) {
                    return p.x >= 0 && p.x < 1 && p.y >= 0 && p.y < 1;
                });
                CHECK(inside);
                CHECK(ch02::estimate(points, [](Vec2) { return 1; }) == 1);
            }
    }

    TEST_CASE("variance: 36 darts, uniform 0.0749, in 6 x 6 strata 0.0162") {
        RunningStats uniform = estimates(PointSet::uniform, 36, 20000, ch02::quarter_circle);
        RunningStats jittered = estimates(PointSet::jittered, 36, 20000, ch02::quarter_circle);
        check_variance(uniform, dart_variance / 36, 3);
        check_variance(jittered, 0.0162201310097, 3);
        CHECK(std::abs(uniform.variance() / jittered.variance() / 4.6183457178 - 1) < 0.07);
    }

    TEST_CASE("variance: for xy that of k x k strata falls as k^-4, N-rooks keep the interaction") {
        for (uint32_t n : {2u, 4u, 8u, 16u}) {
            double n2 = n * n, truth = 1 / (18 * n2 * n2) - 1 / (144 * n2 * n2 * n2);
            check_variance(estimates(PointSet::jittered, n * n, 10000, ch02::product), truth, 3);
        }
        // To first order in 1/N; N = 256 leaves the 5 % of the gate.
        RunningStats rooks = estimates(PointSet::rooks, 256, 10000, ch02::product);
        check_variance(rooks, 1.0 / 144 / 256, 3);
        RunningStats rooks_pi = estimates(PointSet::rooks, 256, 10000, ch02::quarter_circle);
        check_variance(rooks_pi, 1.102641682115 / 256, 3);
    }

    TEST_CASE("variance: N intervals on a line, N^-3 for x^2 and N^-2 for a step") {
        for (uint32_t n : {2u, 4u, 16u, 64u}) {
            double N = n, truth = 1 / (9 * N * N * N) - 1 / (45 * std::pow(N, 5));
            check_variance(estimates(PointSet::rooks, n, 10000, column), truth, 3);
        }
        auto step = [](Vec2 p) { return double{p.x} < 1 / pi_exact ? 1 : 0; };
        for (uint32_t n : {10u, 100u, 1000u}) {
            double a = n / pi_exact - std::floor(n / pi_exact), q = a * (1 - a);
            RunningStats s = estimates(PointSet::rooks, n, 5000, step);
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
        CHECK(ch02::fraction_seen(0.7) == doctest::Approx(0.5).epsilon(1e-14).scale(0));
        CHECK(ch02::fraction_seen(1.4) == doctest::Approx(1).epsilon(1e-14).scale(0));
        CHECK(ch02::fraction_seen(9) == doctest::Approx(1).epsilon(1e-12).scale(0));
        for (double p : {0.1, 0.3, 0.65, 0.9, 1.3}) {
            Points points = grid(1000);
            double counted = ch02::estimate(points, [&](Vec2 u) { return ch02::sees_light(u, p); });
            CHECK(std::abs(ch02::fraction_seen(p) - counted) < 1e-4);
        }
    }

    TEST_CASE("variance: the error falls with the slope of theory") {
        auto slopes = [](PointSet set) {
            std::vector<double> n, edge, smooth;
            for (uint32_t N : {16u, 64u, 256u, 1024u}) {
                ch02::Measurement m = ch02::measure(set, N, 400, 1);
                n.push_back(N);
                edge.push_back(m.errors[0]);
                smooth.push_back(m.errors[1]);
            }
            return std::pair{fitted_slope(n, edge), fitted_slope(n, smooth)};
        };
        // 400 runs know an error to 3.5 %, and a slope over a factor 64 to 0.012.
        constexpr double gate = 0.06;
        auto check = [&](PointSet set, double edge, double smooth) {
            auto [measured_edge, measured_smooth] = slopes(set);
            CHECK(std::abs(measured_edge - edge) < gate);
            CHECK(std::abs(measured_smooth - smooth) < gate);
        };
        check(PointSet::uniform, -0.5, -0.5);
        check(PointSet::rooks, -0.5, -0.5);
        check(PointSet::jittered, -0.73, -1.0);  // the exact variances of 4 x 4 and 32 x 32: -0.730
    }
}

// Chapter 04: exact means and variances of sums and integrals, and densities that fail.
#include <doctest/doctest.h>

#include <array>
#include <utility>

#include "chapters/04_importance/figure.h"
#include "tests/support/gates.h"

namespace {

using ch04::Density;
using ch04::Experiment;

constexpr double lowest_u = 0x1p-49, highest_u = 1 - 0x1p-49;  // of open_unit
constexpr Density all_densities[] = {ch04::uniform,      ch04::linear,  ch04::quadratic,
                                     ch04::inverse_root, ch04::falling, ch04::rising,
                                     ch04::left_half,    ch04::distance};

double relative(double value, double truth) { return std::abs(value / truth - 1); }

Experiment find(const std::vector<Experiment>& list, const std::string& what,
                const std::string& density) {
    for (const Experiment& e : list)
        if (e.what == what && e.density == density) return e;
    FAIL("no experiment ", what, " with ", density);
    return {};
}

/// Moments of X(u) over u in (0,1) by the midpoint rule.
struct Moments {
    double mean = 0, variance = 0, kurtosis = 0;
};
Moments moments(const Experiment& e, int n) {
    std::vector<double> X;
    Moments m;
    for (int i = 0; i < n; i++) X.push_back(e.X((i + 0.5) / n));
    for (double x : X) m.mean += x / n;
    for (double x : X) m.variance += std::pow(x - m.mean, 2) / n;
    for (double x : X) m.kurtosis += std::pow(x - m.mean, 4) / n;
    m.kurtosis /= m.variance * m.variance;
    return m;
}

}  // namespace

TEST_SUITE("ch04 sums") {
    TEST_CASE("density: choices by chance") {
        std::vector<double> pmf = {0.1, 0, 0.4, 0.2, 0.3};
        std::array<double, 4> counts{}, expected = {10000, 40000, 20000, 30000};
        Sampler sampler(SamplerType::independent, 1, 1);
        for (uint32_t i = 0; i < 100000; i++) {
            sampler.start(0, i);
            size_t choice = ch04::sample_pmf(pmf, double{sampler.u1()});
            REQUIRE(choice != 1);
            counts[choice == 0 ? 0 : choice - 1]++;
        }
        CHECK(chi_square_tail(chi_square(counts, expected), 3) > 1e-6);
    }

    TEST_CASE("failure: a choice of probability 0 is never made, also not by rounding") {
        CHECK(ch04::sample_pmf({0, 1}, 0) == 1);
        CHECK(ch04::sample_pmf({0, 0.5, 0, 0.5, 0}, 0.5) == 3);
        CHECK(ch04::sample_pmf({0.5, 0.4999999, 0}, 0.99999999) == 1);  // sums to less than 1
        CHECK(std::isfinite(ch04::estimate_sum({5, 1}, {0, 1}, 0)));
    }

    TEST_CASE("truth: mean and variance of two dice under eight densities") {
        auto dice = [](const char* density, double mean, double variance) {
            CAPTURE(density);
            Experiment e = find(ch04::sums(), "dice 6a+b", density);
            CHECK(relative(e.truth, 24.5) < 1e-12);
            CHECK(relative(e.mean, mean) < 1e-12);
            CHECK(std::abs(e.variance - variance) < 1e-10);
        };
        dice("fair", 24.5, 1295.0 / 12);
        dice("~ 6a+b, the best", 24.5, 0);
        dice("~ a", 24.5, 13573.0 / 1440);
        dice("~ mean over b", 24.5, 64872482143.0 / 17695367052.0);
        dice("~ root mean square over b", 24.5, 3.6576811462594);
        dice("~ 7-a, backwards", 24.5, 1285417.0 / 1440);
        dice("~ b, the wrong die", 24.5, 13573.0 / 40);
        dice("0 for a = 1: biased", 275.0 / 12, 22475.0 / 432);
    }

    TEST_CASE("identity: the exact variance is E[X^2] - E[X]^2, for any f and probabilities") {
        for (int i = 0; i < 50; i++) {
            std::vector<double> f(6), pmf(6);
            double sum = 0, mean = 0, square = 0;
            for (size_t k = 0; k < f.size(); k++) {
                f[k] = k % 3 == 0 ? 0 : std::sin(i + 7.0 * static_cast<double>(k));
                sum += pmf[k] = k == 2 ? 0 : 1.1 + std::cos(i + 3.0 * static_cast<double>(k));
            }
            for (size_t k = 0; k < f.size(); k++) {
                pmf[k] /= sum;
                if (pmf[k] == 0) continue;
                mean += f[k], square += f[k] * f[k] / pmf[k];
            }
            CHECK(std::abs(ch04::exact_variance(f, pmf) - (square - mean * mean)) < 1e-10 * square);
        }
    }

    TEST_CASE("truth: mean and variance of two lights") {
        auto lights = [](const char* what, const char* density, double mean, double variance) {
            Experiment e = find(ch04::sums(), what, density);
            CHECK(relative(e.mean, mean) < 1e-14);
            CHECK(std::abs(e.variance - variance) <= 1e-12 * variance);
        };
        lights("lights 1, 1", "1/4, 3/4", 2, 4.0 / 3);
        lights("lights 1, 1", "1/2, 1/2", 2, 0);
        lights("lights 1, 3", "1/2, 1/2", 4, 4);
        lights("lights 1, 3", "1/4, 3/4", 4, 0);
        lights("lights 1, 999", "1/2, 1/2", 1000, 996004);
        lights("lights 1, 999", "0.999, 0.001", 1000, 996004000000.0 / 999);
        lights("lights 1, 999", "0, 1: biased", 999, 0);
    }

    TEST_CASE("truth: a thousand choices of 25 % and 75 % sum to 2000, with 4/3 and not 1.3333") {
        Experiment e = find(ch04::sums(), "lights 1, 1", "1/4, 3/4");
        CHECK(e.X(0.1) == 4);
        CHECK(e.X(0.9) == 4.0 / 3);
        CHECK(250 * e.X(0.1) + 750 * e.X(0.9) == nearly(2000, 1e-15));
        CHECK(250 * 4 + 750 * 1.3333 == nearly(1999.975, 1e-15));
    }
}

TEST_SUITE("ch04 densities") {
    TEST_CASE("consistency: invert finds the u of a sample") {
        for (const Density& density : all_densities) {
            CAPTURE(std::string(density.name));
            for (double u : {lowest_u, 1e-6, 0.05, 0.1, 0.3, 0.5, 0.9, 0.999999, highest_u}) {
                double x = density.sample(u);
                CHECK(x >= 0);
                CHECK(x <= 1);
                CHECK(std::abs(density.invert(x) - u) < 1e-12);
            }
        }
    }

    TEST_CASE("jacobian: the density is the slope of the inverse") {
        for (const Density& density : all_densities) {
            CAPTURE(std::string(density.name));
            for (double x : {0.01, 0.1, 0.24, 0.26, 0.4, 0.49}) {
                constexpr double h = 1e-5;
                double slope = (density.invert(x + h) - density.invert(x - h)) / (2 * h);
                CHECK(relative(slope, density.pdf(x)) < 1e-5);
            }
        }
    }

    TEST_CASE("identity: random numbers stay off 0 and 1, and every sample is finite") {
        constexpr float largest = 0x1.fffffep-1f;
        CHECK(ch04::open_unit({0, 0}) == lowest_u);
        CHECK(ch04::open_unit({largest, largest}) == highest_u);
        CHECK(ch04::open_unit({0.5f, 0}) > 0.5);
        for (const Experiment& e : ch04::integrals())
            for (double u : {lowest_u, highest_u}) CHECK(std::isfinite(e.X(u)));
        // and where there is nothing to divide by, nothing is divided
        auto root = [](double x) { return 1 / std::sqrt(x); };
        CHECK(ch04::estimate_integral(root, ch04::inverse_root, 0) == 0);
        CHECK(ch04::estimate_integral(root, ch04::linear, 0) == 0);
    }
}

TEST_SUITE("ch04 integrals") {
    TEST_CASE("truth: mean and variance of each integrand and density, against quadrature") {
        for (const Experiment& e : ch04::integrals()) {
            if (std::isinf(e.variance)) continue;
            Moments m = moments(e, 1000000);
            // Midpoints see a step to 1e-6; x^-1/2, the square of x^-1/4, only to 1/sqrt(n).
            double tolerance = e.what == "x^-1/4" ? 5e-3 : 1e-5;
            CHECK(relative(m.mean, e.mean) < tolerance);
            if (e.variance == 0)
                CHECK(m.variance < 1e-20);
            else
                CHECK(relative(m.variance, e.variance) < tolerance);
        }
    }

    TEST_CASE("identity: a density proportional to f >= 0 makes every sample the integral") {
        for (double u : {lowest_u, 0.001, 0.37, 0.999, highest_u}) {
            CHECK(relative(find(ch04::integrals(), "x^-1/2", "1/(2 sqrt x)").X(u), 2) < 1e-15);
            CHECK(relative(find(ch04::integrals(), "x^2", "3x^2").X(u), 1.0 / 3) < 1e-15);
        }
    }

    TEST_CASE("failure: without the division x^2 under 2x comes out as 1/2") {
        Experiment e = find(ch04::integrals(), "x^2, not divided", "2x");
        CHECK(e.mean == 0.5);
        RunningStats s = ch04::run(e, 100000, 1).stats;
        CHECK(std::abs(s.mean() - 1.0 / 3) > 100 * s.standard_error());
    }

    TEST_CASE("identity: of N equal samples each has the share 1/N of the squares") {
        Experiment e = find(ch04::integrals(), "x^-1/2", "1/(2 sqrt x)");
        CHECK(ch04::run(e, 1000, 1).largest_share == nearly(0.001, 1e-12));
        CHECK(ch04::run(e, 1, 1).largest_share == 1);
    }
}

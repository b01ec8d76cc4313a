// Laws of sets of points on the unit square, for chapters 02 and 03.
#pragma once
#include <algorithm>

#include "common/path/sampler.h"
#include "common/render/options.h"
#include "tests/support/gates.h"

inline constexpr double dart_variance = pi_exact * (4 - pi_exact);

/// Estimates of the integral of f from `runs` sets; estimate(seed, f): from one.
template <class Estimate, class Function>
RunningStats estimates(Estimate estimate, uint32_t runs, Function f) {
    RunningStats stats;
    for (uint32_t run = 0; run < runs; run++) stats.add(estimate(hash32(run, 2), f));
    return stats;
}

/// Estimates from sets are right in the mean, for pi, for xy and for e^(x+y); any number of points
/// is on the square, and the average of 1 is exactly 1. make(n, seed): n points, or about n.
template <class Make, class Estimate>
void check_points(Make make, Estimate estimate, uint32_t step = 1, bool about = false) {
    for (uint32_t n = 1; n <= 200; n += n < 3 ? 1 : step) {
        std::vector<Vec2> points = make(n, n);
        CHECK((about || points.size() == n));
        bool inside = std::all_of(points.begin(), points.end(), [](Vec2 p) {
            return p.x >= 0 && p.x < 1 && p.y >= 0 && p.y < 1;
        });
        CHECK(inside);
        CHECK(estimate(points, [](Vec2) { return 1; }) == 1);
    }
    auto dart = [](Vec2 p) { return double{p.x} * double{p.x} + double{p.y} * double{p.y} <= 1; };
    auto product = [](Vec2 p) { return double{p.x} * double{p.y}; };
    auto exponential = [](Vec2 p) { return std::exp(double{p.x} + double{p.y}); };
    double e = std::numbers::e, variance = std::pow((e * e - 1) / 2, 2) - std::pow(e - 1, 4);
    for (uint32_t n : {1u, 7u, 16u}) {
        RunningStats of_dart, of_product, of_sum;
        for (uint32_t run = 0; run < (n == 1 ? 14000 : 2000); run++) {
            std::vector<Vec2> points = make(n, hash32(run, 2));
            of_dart.add(estimate(points, dart));
            of_product.add(estimate(points, product));
            of_sum.add(estimate(points, exponential));
        }
        // The variance of free points bounds the gate: no set is worse.
        check_mean(of_dart, pi_exact / 4, dart_variance / 16 / n, 0.03);
        check_mean(of_product, 0.25, 7.0 / 144 / n, 0.02);
        check_mean(of_sum, (e - 1) * (e - 1), variance / n, 0.2);
    }
}

/// The errors of measure(N) fall with the slopes of theory.
template <class Measure>
void check_slopes(Measure measure, const std::vector<double>& theory) {
    const std::vector<double> counts = {16, 64, 256, 1024};
    std::vector<decltype(measure(1u))> measured;
    for (double n : counts) measured.push_back(measure(static_cast<uint32_t>(n)));
    for (size_t k = 0; k < theory.size(); k++) {
        CAPTURE(k);
        std::vector<double> errors;
        for (const auto& m : measured) errors.push_back(m.errors[k]);
        // 400 runs know an error to 3.5 %, and a slope over a factor 64 to 0.012.
        CHECK(std::abs(fitted_slope(counts, errors) - theory[k]) < 0.06);
    }
}

// Gates for stochastic tests: fixed seeds, known variances, five standard errors.
#pragma once
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "common/base/stats.h"
#include "common/base/vec.h"

inline constexpr double pi_exact = std::numbers::pi;

/// The mean of independent samples is within 5 standard errors of `truth`, by the KNOWN variance of
/// one sample; a right estimator fails once in 1.7 million seeds. `resolution` is the bias that the
/// test must be able to see: 8 standard errors of it, so that such a bias fails in 99.9 %.
inline void check_mean(const RunningStats& s, double truth, double variance, double resolution) {
    double se = std::sqrt(variance / static_cast<double>(s.count()));
    CAPTURE(s.mean());
    CAPTURE(truth);
    CAPTURE(se);
    CHECK(std::isfinite(s.mean()));
    CHECK(std::abs(s.mean() - truth) <= 5 * se);
    CHECK(8 * se <= resolution);
}

/// The sample variance is within 5 of its own standard errors, sqrt((kurtosis - 1) / N), of
/// `truth`. kurtosis  E (X - mean)^4 / variance^2; 3 for a normal distribution, such as the mean of
/// many
inline void check_variance(const RunningStats& s, double truth, double kurtosis) {
    double relative_se = std::sqrt((kurtosis - 1) / static_cast<double>(s.count()));
    CAPTURE(s.variance());
    CAPTURE(truth);
    CAPTURE(relative_se);
    CHECK(std::isfinite(s.variance()));
    CHECK(std::abs(s.variance() / truth - 1) <= 5 * relative_se);
    CHECK(relative_se <= 0.05);
}

inline Rgb grey(double v) {
    float x = static_cast<float>(v);
    return {x, x, x};
}

/// x, to this relative error.
inline doctest::Approx nearly(double x, double error = 1e-6) {
    return doctest::Approx(x).epsilon(error).scale(0);
}

/// sum (count - expected)^2 / expected
inline double chi_square(std::span<const double> counts, std::span<const double> expected) {
    double sum = 0;
    for (size_t i = 0; i < counts.size(); i++)
        sum += (counts[i] - expected[i]) * (counts[i] - expected[i]) / expected[i];
    return sum;
}

/// The same for cells that are equally likely.
inline double chi_square(std::span<const double> counts) {
    double total = 0;
    for (double c : counts) total += c;
    return chi_square(counts,
                      std::vector(counts.size(), total / static_cast<double>(counts.size())));
}

/// The chance that chi^2 of so many degrees of freedom is larger than x; gates ask for > 1e-6.
inline double chi_square_tail(double x, int freedom) {
    bool odd = freedom % 2 == 1;
    double h = x / 2, tail = odd ? std::erfc(std::sqrt(h)) : 0;
    double term = odd ? std::exp(-h) * std::sqrt(h) / std::tgamma(1.5) : std::exp(-h);
    for (int k = odd ? 3 : 2; k <= freedom; k += 2) {
        tail += term;
        term *= h / (k / 2.0);
    }
    return tail;
}

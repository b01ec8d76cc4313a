// Chapter 01: the average over random points, and its estimated error.
#pragma once
#include <cmath>
#include <cstdint>

#include "common/path/sampler.h"

namespace ch01 {

/// The score of a dart that hits the unit square at x: its average over all darts is pi.
///
///   X = 4 [x^2 + y^2 <= 1]        E[X] = pi,  Var X = pi (4 - pi) = 2.697
///
/// source  area of the quarter circle, pi/4
/// tested by  "truth: mean and variance of a dart", within 5 standard errors
inline double score_dart(Vec2 x) {
    return double{x.x} * double{x.x} + double{x.y} * double{x.y} <= 1 ? 4 : 0;
}

/// Running mean and variance of the samples added so far, in one pass and without cancellation.
///
///   delta = x - mean;   mean += delta / n;   m2 += delta (x - mean)
///
/// source  Welford 1962; merge: Chan, Golub, LeVeque 1979
/// tested by  "truth: Welford keeps the digits that E[x^2] - E[x]^2 loses",
///            mean to 1e-15, variance within 1e-6
class RunningStats {
public:
    void add(double x) {
        n_++;
        double delta = x - mean_;
        mean_ += delta / static_cast<double>(n_);
        m2_ += delta * (x - mean_);
    }
    void merge(const RunningStats& b) {
        if (b.n_ == 0) return;
        double n = static_cast<double>(n_ + b.n_), delta = b.mean_ - mean_;
        mean_ += delta * static_cast<double>(b.n_) / n;
        m2_ += b.m2_ + delta * delta * static_cast<double>(n_) * static_cast<double>(b.n_) / n;
        n_ += b.n_;
    }
    uint64_t count() const { return n_; }
    double mean() const { return mean_; }
    /// Variance of a single sample (an unbiased estimate); 0 for fewer than two samples.
    double variance() const { return n_ < 2 ? 0 : m2_ / static_cast<double>(n_ - 1); }
    /// Standard error of the mean, if the samples are independent.
    double standard_error() const {
        return n_ == 0 ? 0 : std::sqrt(variance() / static_cast<double>(n_));
    }

private:
    uint64_t n_ = 0;
    double mean_ = 0, m2_ = 0;
};

/// Estimates E[score(u)], u uniform on the unit square, from darts first .. last-1.
///
///   E[X] ~ (1/N) sum X_i,        standard error sqrt(Var X / N)
///
/// bias 0; each dart depends only on seed and number, so ranges of darts can be thrown separately
/// and merged.      tested by  "truth: mean and variance of a dart", within 5 standard errors
template <class Score>
RunningStats throw_darts(Score score, uint64_t first, uint64_t last, uint32_t seed) {
    RunningStats stats;
    Sampler sampler(SamplerType::independent, seed, 1);
    for (uint64_t i = first; i < last; i++) {
        sampler.start(static_cast<uint32_t>(i >> 32), static_cast<uint32_t>(i));
        stats.add(score(sampler.u2()));
    }
    return stats;
}

/// The measured standard error: the spread of the estimates of `runs` experiments of n darts each.
template <class Score>
double measured_standard_error(Score score, uint64_t n, uint32_t runs, uint32_t seed) {
    RunningStats estimates;
    for (uint32_t run = 1; run <= runs; run++)
        estimates.add(throw_darts(score, 0, n, hash32(seed, run)).mean());
    return std::sqrt(estimates.variance());
}

/// The sum n x, by adding x to a float n times. It stops growing at about 2^24 x.
///
/// From 2^24 on, neighbouring floats are 2 apart, and 2^24 + 1 rounds back to 2^24.
/// tested by  "failure: a float counter stops at 2^24", exactly
inline float sum_in_float(float x, uint64_t n) {
    float sum = 0;
    for (uint64_t i = 0; i < n; i++) sum += x;
    return sum;
}

// A dart board of radius 1 with rings, and the probability density of a player's hits.

struct Ring {
    double radius, score;
};
inline constexpr Ring board[] = {{0.1, 10}, {0.3, 5}, {0.6, 2}, {1, 1}};
inline constexpr double sigma = 0.5;  // standard deviation of a hit, in x and in y

/// f(x), the score of a hit at x; 0 off the board.
inline double score_board(Vec2 x) {
    double r = std::hypot(double{x.x}, double{x.y});
    for (Ring ring : board)
        if (r <= ring.radius) return ring.score;
    return 0;
}

/// Samples the point of a hit: normally distributed around the centre.
///
///   r = sigma sqrt(-2 ln(1 - u.x)),  angle = 2 pi u.y
///
/// u       in [0,1)^2
/// source  Box, Muller 1958      tested by  "density: hits of the dart board", chi^2 at 1e-6
inline Vec2 sample_hit(Vec2 u) {
    double r = sigma * std::sqrt(-2 * std::log1p(-double{u.x}));
    double angle = 2 * std::numbers::pi * double{u.y};
    return {static_cast<float>(r * std::cos(angle)), static_cast<float>(r * std::sin(angle))};
}

/// The density of sample_hit per unit area.
inline double pdf_hit(Vec2 x) {
    double r2 = std::pow(double{x.x}, 2) + std::pow(double{x.y}, 2);
    return std::exp(-r2 / (2 * sigma * sigma)) / (2 * std::numbers::pi * sigma * sigma);
}

/// The u for which sample_hit(u) is x.
inline Vec2 invert_hit(Vec2 x) {
    double r2 = std::pow(double{x.x}, 2) + std::pow(double{x.y}, 2);
    double turns = std::atan2(double{x.y}, double{x.x}) / (2 * std::numbers::pi);
    return {static_cast<float>(-std::expm1(-r2 / (2 * sigma * sigma))),
            static_cast<float>(turns < 0 ? turns + 1 : turns)};
}

/// The average score  E[f] = integral of f(x) p(x) dx, ring by ring in closed form.
///
///   P(r <= R) = 1 - exp(-R^2 / (2 sigma^2))
///
/// tested by  "truth: the average score of the board", to 1e-7
inline double expected_score() {
    double expected = 0, outside = 1;
    for (Ring ring : board) {
        double beyond = std::exp(-ring.radius * ring.radius / (2 * sigma * sigma));
        expected += ring.score * (outside - beyond);
        outside = beyond;
    }
    return expected;
}

}  // namespace ch01

// taught by chapter 01
// Running statistics: mean, variance and standard error of a stream of numbers.
#pragma once
#include <cmath>
#include <cstdint>

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

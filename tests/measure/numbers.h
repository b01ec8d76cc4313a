// What measured numbers say: how far renders with different seeds lie apart, whether methods agree,
// and how many times faster one is.
#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "common/base/stats.h"
#include "common/picture/image.h"

inline double median(std::vector<double> values) {
    if (values.empty()) return std::nan("");
    std::sort(values.begin(), values.end());
    size_t middle = values.size() / 2;
    return values.size() % 2 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

/// Mean and variance of each pixel and channel over renders with different seeds.
class Spread {
public:
    void add(const Image& image) {
        width_ = image.width, height_ = image.height;
        sums_.resize(3 * image.pixels.size());
        for (size_t i = 0; i < image.pixels.size(); i++) {
            Rgb p = image.pixels[i];
            sums_[3 * i].add(double{p.r});
            sums_[3 * i + 1].add(double{p.g});
            sums_[3 * i + 2].add(double{p.b});
        }
    }

    Image mean() const {
        Image image(width_, height_);
        auto channel = [&](size_t i) { return static_cast<float>(sums_[i].mean()); };
        for (size_t i = 0; i < image.pixels.size(); i++) {
            image.pixels[i] = {channel(3 * i), channel(3 * i + 1), channel(3 * i + 2)};
        }
        return image;
    }

    /// The relMSE that one of the renders has on average: variance / (mean^2 + 0.01), averaged over
    /// pixels and channels.
    ///
    /// mean  the best picture there is: by its own mean, a noisy method's rare and bright pixels
    ///       would count for less than they should
    /// tested by  "truth: relMSE from the spread of renders"
    double rel_mse(const Image& mean) const {
        double sum = 0;
        auto add = [&](size_t i, float m) {
            sum += sums_[i].variance() / (double{m} * double{m} + 0.01);
        };
        for (size_t i = 0; i < mean.pixels.size(); i++) {
            add(3 * i, mean.pixels[i].r);
            add(3 * i + 1, mean.pixels[i].g);
            add(3 * i + 2, mean.pixels[i].b);
        }
        return sum / static_cast<double>(sums_.size());
    }
    /// The mean squared error of one of the renders: the variance, averaged alike.
    double mse() const {
        double sum = 0;
        for (const RunningStats& s : sums_) sum += s.variance();
        return sum / static_cast<double>(sums_.size());
    }

private:
    int width_ = 0, height_ = 0;
    std::vector<RunningStats> sums_;
};

/// What one method says of a quantity: the values of independent batches, summed up.
struct Estimate {
    double mean = 0, se = 0, skewness = 0;
    double missed = 0;  // that others have found of it, in classes of paths that were not met here

    /// Few batches with large values among many without say nothing of their spread: their error
    /// comes out too small just when the mean does. So it does where none was met at all.
    bool reliable() const { return se > 0 && std::abs(skewness) <= 1 && missed <= se; }
};

/// skewness  third central moment of the values over the 3/2th power of the second
inline Estimate estimate_of(const std::vector<double>& values) {
    double n = static_cast<double>(values.size()), mean = 0, m2 = 0, m3 = 0;
    for (double x : values) mean += x / n;
    for (double x : values) {
        m2 += (x - mean) * (x - mean) / n;
        m3 += (x - mean) * (x - mean) * (x - mean) / n;
    }
    // Below a millionth of the mean, differences are rounding.
    double rounding = 1e-6 * std::abs(mean);
    bool noise = std::sqrt(m2) > rounding;
    return {mean, std::hypot(std::sqrt(m2 / (n - 1)), rounding),
            noise ? m3 / std::pow(m2, 1.5) : 0};
}

/// A method against all others, which are pooled by 1 / se^2.
struct Verdict {
    double z = 0;
    double others_mean = 0, others_se = 0;
    bool known = false;
};

/// Verdict number i: estimate i against the reliable ones among the rest.
///
/// tested by  "truth: z of three estimates"
inline Verdict judge(const std::vector<Estimate>& estimates, size_t i) {
    Verdict v;
    double weights = 0;
    for (size_t k = 0; k < estimates.size(); k++) {
        if (k == i || !estimates[k].reliable()) continue;
        double weight = 1 / (estimates[k].se * estimates[k].se);
        v.others_mean += weight * estimates[k].mean;
        weights += weight;
    }
    if (weights == 0 || !estimates[i].reliable()) return v;
    v.others_mean /= weights;
    v.others_se = 1 / std::sqrt(weights);
    v.z = (estimates[i].mean - v.others_mean) / std::hypot(estimates[i].se, v.others_se);
    v.known = true;
    return v;
}

/// An error that falls with time: relMSE, which is inverse to the time where all is well.
struct ErrorLine {
    std::vector<double> seconds, error;
};

/// Seconds until the line is at this error for good: between two of its points on the straight line
/// of their logarithms, before the first and after the last as if error times seconds stayed what
/// it is there. NaN for a line without points; tested by "truth: times faster at equal error".
inline double seconds_at(const ErrorLine& line, double error) {
    size_t n = line.error.size(), above = n;
    if (n == 0) return NAN;
    for (size_t i = 0; i < n; i++)
        if (line.error[i] >= error) above = i;
    if (above == n) return line.seconds[0] * line.error[0] / error;
    if (above == n - 1) return line.seconds[above] * line.error[above] / error;
    double part =
        std::log(line.error[above] / error) / std::log(line.error[above] / line.error[above + 1]);
    return line.seconds[above] * std::pow(line.seconds[above + 1] / line.seconds[above], part);
}

/// How many times less time the one takes than the other, at the smallest error that one of them
/// has reached. At larger errors the faster one takes so few samples that most of its time is that
/// before the first sample.
inline double times_faster(const ErrorLine& one, const ErrorLine& other) {
    if (one.error.empty() || other.error.empty()) return NAN;
    double error = std::min(one.error.back(), other.error.back());
    return seconds_at(other, error) / seconds_at(one, error);
}

// How far renders with different seeds lie apart.
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

// The film: sums of samples, pixel by pixel, and what they say about their own error.
#pragma once
#include <cstdint>
#include <vector>

#include "common/picture/image.h"

/// The samples of one pixel so far: their sum, and Welford's mean and squares of their brightness
/// (the average of the channels).
struct PixelSum {
    double r = 0, g = 0, b = 0;
    double mean = 0, m2 = 0;
};

/// Adds up samples. All sums are in double: in float, one of 2^24 equal samples no longer counts.
class Film {
public:
    int width, height;
    uint64_t spp = 0;  // samples that every pixel has

    Film(int w, int h)
        : width(w), height(h), pixels_(static_cast<size_t>(w) * static_cast<size_t>(h)) {}

    /// Adds sample number `sample` (from 0) of a pixel; each pixel gets its samples in order.
    void add(size_t pixel, uint64_t sample, Rgb L) {
        add_part(pixel, L);
        PixelSum& p = pixels_[pixel];
        double y =
            (static_cast<double>(L.r) + static_cast<double>(L.g) + static_cast<double>(L.b)) / 3;
        double delta = y - p.mean;
        p.mean += delta / static_cast<double>(sample + 1);
        p.m2 += delta * (y - p.mean);
    }

    /// Adds what part of a sample brings, as often as it has parts: to the sums alone, so that the
    /// film knows its mean but not its error.
    void add_part(size_t pixel, Rgb L) {
        PixelSum& p = pixels_[pixel];
        p.r += static_cast<double>(L.r);
        p.g += static_cast<double>(L.g);
        p.b += static_cast<double>(L.b);
    }

    /// The mean of the samples, as a picture.
    Image image() const;

    /// Mean over pixels and channels.
    double mean() const;
    Rgb mean_rgb() const;

    /// Standard error of mean(), from the variance within the pixels; unknown (NaN) for one sample.
    /// Exact for independent samples, too large for stratified and Sobol ones.
    double standard_error() const;

    /// (sum x)^2 / sum x^2 over all samples of the film: how many samples really carry it.
    double effective_samples() const;

    const std::vector<PixelSum>& pixels() const { return pixels_; }

private:
    std::vector<PixelSum> pixels_;
};

// The film: sums of samples, pixel by pixel, and what they say about their own error.
#pragma once
#include <cstdint>
#include <vector>

#include "common/base/exact_sum.h"
#include "common/picture/image.h"

/// The samples of one pixel so far: their number, their sum, and Welford's mean and squares of
/// their brightness (the average of the channels).
struct PixelSum {
    double r = 0, g = 0, b = 0;
    double mean = 0, m2 = 0;
    uint64_t n = 0;
};

/// Adds up samples. All sums are in double: in float, one of 2^24 equal samples no longer counts.
/// Each pixel counts its own samples, and has the mean of those.
class Film {
public:
    int width, height;

    Film(int w, int h, bool takes_splats = false)
        : width(w),
          height(h),
          pixels_(static_cast<size_t>(w) * static_cast<size_t>(h)),
          splats_(takes_splats ? 3 * pixels_.size() : 0) {}

    /// Adds the next sample of a pixel. Two threads must not add to one pixel.
    void add(size_t pixel, Rgb L) {
        add_part(pixel, L);
        PixelSum& p = pixels_[pixel];
        p.n++;
        double y =
            (static_cast<double>(L.r) + static_cast<double>(L.g) + static_cast<double>(L.b)) / 3;
        double delta = y - p.mean;
        p.mean += delta / static_cast<double>(p.n);
        p.m2 += delta * (y - p.mean);
    }

    /// Adds what part of a sample brings, as often as it has parts: to the sums alone, so that the
    /// film knows its mean but not its error. How many samples there were, count_as() tells.
    void add_part(size_t pixel, Rgb L) {
        PixelSum& p = pixels_[pixel];
        p.r += static_cast<double>(L.r);
        p.g += static_cast<double>(L.g);
        p.b += static_cast<double>(L.b);
    }
    /// This film holds parts of all the samples of `whole`.
    void count_as(const Film& whole) {
        for (size_t i = 0; i < pixels_.size(); i++) pixels_[i].n = whole.pixels_[i].n;
    }

    /// Adds what a path from a light brings to a pixel that it happens to meet, from any thread.
    /// The picture is the mean of the samples plus the sum of the splats over spp(): one path from
    /// a light for each sample.
    void splat(size_t pixel, Rgb L) {
        splats_[3 * pixel].add(L.r);
        splats_[3 * pixel + 1].add(L.g);
        splats_[3 * pixel + 2].add(L.b);
    }

    /// What each pixel has, as a picture; black where it has nothing yet.
    Image image() const;

    /// Mean over channels and the pixels that have samples.
    double mean() const;
    Rgb mean_rgb() const;

    /// Standard error of mean(), from the variance within the pixels; unknown (NaN) where a pixel
    /// has one sample alone, and for a film that takes splats.
    /// Exact for independent samples, too large for stratified and Sobol ones.
    double standard_error() const;

    /// (sum x)^2 / sum x^2 over all samples of the film: how many samples really carry it.
    double effective_samples() const;

    /// All samples; samples per pixel, on the mean.
    uint64_t samples() const;
    double spp() const {
        return static_cast<double>(samples()) / static_cast<double>(pixels_.size());
    }

    const std::vector<PixelSum>& pixels() const { return pixels_; }

private:
    struct Channels {
        double r = 0, g = 0, b = 0;
    };
    Channels mean_of(size_t pixel, double spp) const;
    Channels mean_channels() const;

    std::vector<PixelSum> pixels_;
    std::vector<ExactSum> splats_;  // r, g and b of each pixel; none for a film without
};

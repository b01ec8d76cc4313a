// Chapter 19: adaptive sampling. A few pilot samples of each pixel estimate its error; the other
// samples go where it is large. Chapter 18 traces the paths.
//
//   error^2 = sum over the pixels of  v_i / n_i   is least, for a given sum of n_i c_i, where
//   n_i is proportional to sqrt(v_i / c_i)        v_i: the relative variance of a pixel's samples
//                                                 c_i: the cost of a sample, in rays
#pragma once
#include <memory>
#include <numeric>

#include "common/base/parallel.h"
#include "common/path/dispersion.h"
#include "common/path/method.h"

namespace ch19 {

using dispersion::trace, dispersion::prepare;

/// The relative variance of a pixel's samples. It is relative as in relMSE: errors in dark and in
/// bright pixels count alike.
///
///   v = average over the channels of  variance / (mean^2 + 0.01)      0 for fewer than two samples
/// tested by  "truth: a pixel varies as relMSE measures it, channel by channel", to 1e-6
inline double relative_variance(const PilotPixel& p) {
    double v = 0;
    for (int c : {0, 1, 2}) v += p.m2[c] / (p.mean[c] * p.mean[c] + 0.01) / 3;
    return v / std::max(p.n - 1.0, 1.0);
}

/// Averages s over 5 neighbours in each row, and transposes: applied twice, it averages 5 x 5
/// pixels, since the few samples of one pixel give a noisy variance.
inline std::vector<double> filter_and_transpose(const std::vector<double>& s, int width) {
    int height = static_cast<int>(s.size()) / width;
    std::vector<double> result;
    for (int x = 0; x < width; x++) {
        int first = std::max(x - 2, 0), last = std::min(x + 2, width - 1);
        for (int y = 0; y < height; y++) {
            auto row = s.begin() + y * width;
            double sum = std::accumulate(row + first, row + last + 1, 0.0);
            result.push_back(sum / (last - first + 1));
        }
    }
    return result;
}

/// The relative density of samples in each pixel (average 1), from the pilot's variances and rays.
///
///   density = s / (mean of s),    s = sqrt(v / c), averaged over neighbours
///
/// source  Neyman 1934      tested by  "truth: sample densities are those ...", to 2 %
inline std::vector<double> sample_density(const std::vector<PilotPixel>& pixels, int width) {
    std::vector<double> s;
    for (const PilotPixel& p : pixels)
        s.push_back(std::sqrt(relative_variance(p) / std::max(p.rays, 1u)));
    int height = static_cast<int>(s.size()) / width;
    for (int side : {width, height, width, height}) s = filter_and_transpose(s, side);  // 5x5 twice
    double mean = 0;
    for (double s_i : s) mean += s_i / static_cast<double>(s.size());
    for (double& s_i : s) s_i = mean > 0 ? s_i / mean : 1;
    return s;
}

/// Which pilot decides how many samples a half of a pixel gets: the other half's, or its own.
///
/// other  unbiased: the number of samples does not depend on the samples that are averaged
/// own    biased, too dark: where a pilot missed the light, few samples follow that could find it
enum class PilotHalf { other, own };

/// What the user asks for, and what the pilot has decided: the densities of both halves.
struct SampleDensities {
    uint32_t pilot = 16;  // samples of each pixel, both halves together
    PilotHalf pilot_half = PilotHalf::other;
    std::vector<double> of_half[2] = {};
};
inline void choose_densities(SampleDensities& s, const Pilot& pilot, int threads) {
    parallel_for(2, threads, [&](int half) {
        int decides = s.pilot_half == PilotHalf::other ? 1 - half : half;
        s.of_half[half] = sample_density(pilot.half[decides], pilot.width);
    });
}

/// The factor `scale` with which the average of max(least, scale * density) is `wanted`. A pixel
/// that asks for less gets `least`, and less is left for the others: so `scale` falls in steps.
inline double scale_to_budget(const std::vector<double>& density, double least, double wanted) {
    for (double scale = infinity;;) {
        double sum = 0, left = 0;
        for (double d : density) {
            bool asks = d * scale > least;
            sum += asks ? d : 0, left += asks ? wanted : wanted - least;
        }
        if (!(left / sum < scale)) return scale;
        scale = left / sum;
    }
}

/// The number of samples in a half of each pixel, for `spp` samples per pixel on average.
///
///   n = floor(scale density + u),  at least pilot / 2 + 0.05 (spp - pilot) / 2, at most 8 spp
///
/// At least: a pilot that saw no noise may have missed it. At most: a pilot with one very bright
/// sample may be wrong, too. u in [0,1) differs for each pixel and half: rounding is unbiased.
/// tested by  "identity: samples are as many as the densities say", within 5 standard errors
inline SamplesOf samples_of(const SampleDensities& s, int half, uint32_t spp) {
    uint32_t pilot = std::min(spp, s.pilot), first = (pilot + (half == 0)) / 2;
    if (spp == pilot) return [=](size_t) { return first; };
    double more = (spp - pilot) / 2.0, least = first + 0.05 * more, most = 8.0 * spp;
    double scale = scale_to_budget(s.of_half[half], least, first + more);
    return [=, density = s.of_half[half]](size_t pixel) {
        double u = to_unit_float(hash32(static_cast<uint32_t>(pixel), static_cast<uint32_t>(half)));
        return static_cast<uint32_t>(std::clamp(scale * density[pixel], least, most) + u);
    };
}

/// The allocation for the render loop. A pixel is  (mean of half 0 + mean of half 1) / 2.
inline Allocation allocation(const SampleDensities& wanted) {
    auto s = std::make_shared<SampleDensities>(wanted);
    return {wanted.pilot, [s](const auto&... decided) { choose_densities(*s, decided...); },
            [s](int half, uint32_t spp) { return samples_of(*s, half, spp); }};
}

}  // namespace ch19

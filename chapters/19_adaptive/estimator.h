// Chapter 19: adaptive sampling. A few samples of each pixel tell where the error is; the others
// go there. Chapter 18 traces the paths.
//
//   error^2 = sum over the pixels of  v_i / n_i   is least, for a given sum of n_i c_i, where
//   n_i is proportional to sqrt(v_i / c_i)        v_i: the variance of a pixel's samples
//                                                 c_i: what a sample costs, in rays
#pragma once
#include <memory>
#include <numeric>

#include "common/base/parallel.h"
#include "common/path/dispersion.h"
#include "common/picture/allocation.h"

namespace ch19 {

using dispersion::trace, dispersion::prepare;

/// How much a pixel's samples vary, in the measure in which pictures are compared here: that of
/// relMSE, in which what is dark counts as much as what is bright.
///
///   v = average over the channels of  variance / (mean^2 + 0.01)      0 for fewer than two samples
/// tested by  "truth: a pixel varies as relMSE measures it, channel by channel"
inline double relative_variance(const PilotPixel& p) {
    double v = 0;
    for (int c : {0, 1, 2}) v += p.m2[c] / (p.mean[c] * p.mean[c] + 0.01) / 3;
    return v / std::max(p.n - 1.0, 1.0);
}

/// The mean of s over the 5 pixels of a row around each, rows turned to columns: twice, the mean
/// over 5 x 5. A few samples of one pixel alone tell little.
inline std::vector<double> smooth(const std::vector<double>& s, int width) {
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

/// The share of each pixel in all samples, on the mean 1, from equally many of each and their rays.
///
///   share = s / (mean of s),    s = sqrt(v / c), smooth
///
/// source  Neyman 1934      tested by  "truth: shares are those of the least error"
inline std::vector<double> shares(const std::vector<PilotPixel>& pixels, int width) {
    std::vector<double> s;
    for (const PilotPixel& p : pixels)
        s.push_back(std::sqrt(relative_variance(p) / std::max(p.rays, 1u)));
    int height = static_cast<int>(s.size()) / width;
    for (int side : {width, height, width, height}) s = smooth(s, side);  // 5 x 5, twice
    double mean = 0;
    for (double s_i : s) mean += s_i / static_cast<double>(s.size());
    for (double& s_i : s) s_i = mean > 0 ? s_i / mean : 1;
    return s;
}

/// Who decides how many samples a half of a pixel gets: the other half's pilot, or its own.
///
/// other  the mean is right: the samples that are averaged have no say in how many they are
/// own    it is too dark: where a pilot missed the light, few samples follow that could find it
enum class Judge { other, own };

/// What the user asks for, and what the pilot has decided: the shares of both halves.
struct Shares {
    uint32_t pilot = 16;  // samples of each pixel, of both halves
    Judge judge = Judge::other;
    std::vector<double> of_half[2] = {};
};
inline void share_out(Shares& s, const Pilot& pilot, int threads) {
    parallel_for(2, threads, [&](int half) {
        int judge = s.judge == Judge::other ? 1 - half : half;
        s.of_half[half] = shares(pilot.half[judge], pilot.width);
    });
}

/// The level at which max(least, level share) is `wanted` on the mean: lowered from above as long
/// as further pixels come to have enough already, and leave less for the others.
inline double level_of(const std::vector<double>& shares, double least, double wanted) {
    for (double level = infinity;;) {
        double sum = 0, left = 0;
        for (double share : shares) {
            bool asks = share * level > least;
            sum += asks ? share : 0, left += asks ? wanted : wanted - least;
        }
        if (!(left / sum < level)) return level;
        level = left / sum;
    }
}

/// How many samples a half of each pixel has when there are `spp` a pixel on the mean.
///
///   n = floor(max(least, level share) + u),    least = pilot / 2 + 0.05 (spp - pilot) / 2
///
/// 0.05: what looks even so far may not be so. None has over 16 times the mean, for the same
/// reason. u in [0,1) is another for each pixel and half, so that rounding favours none.
/// tested by  "identity: samples are as many as the shares say"
inline SamplesOf samples_of(std::shared_ptr<const Shares> s, int half, uint32_t spp) {
    uint32_t pilot = std::min(spp, s->pilot), first = (pilot + (half == 0)) / 2;
    if (spp == pilot) return [=](size_t) { return first; };
    double more = (spp - pilot) / 2.0, least = first + 0.05 * more, most = 8.0 * spp;
    double level = level_of(s->of_half[half], least, first + more);
    return [=](size_t pixel) {
        double u = to_unit_float(hash32(static_cast<uint32_t>(pixel), static_cast<uint32_t>(half)));
        return static_cast<uint32_t>(std::clamp(level * s->of_half[half][pixel], least, most) + u);
    };
}

/// For the loop that renders. A pixel is then  (mean of half 0 + mean of half 1) / 2.
inline Allocation allocation(const Shares& wanted) {
    auto s = std::make_shared<Shares>(wanted);
    return {wanted.pilot, [s](const auto&... decided) { share_out(*s, decided...); },
            [s](int half, uint32_t spp) { return samples_of(s, half, spp); }};
}

}  // namespace ch19

// Different numbers of samples for different pixels.
#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "common/base/vec.h"

/// The statistics of the pilot samples of one half of a pixel: mean and sum of (sample - mean)^2 of
/// each channel, computed as in RunningStats.
struct PilotPixel {
    uint32_t n = 0, rays = 0;
    double mean[3] = {}, m2[3] = {};

    void add(Rgb L) {
        double x[3] = {double{L.r}, double{L.g}, double{L.b}}, share = 1.0 / ++n;
        for (int c : {0, 1, 2}) {
            double delta = x[c] - mean[c];
            mean[c] += share * delta;
            m2[c] += delta * (x[c] - mean[c]);
        }
    }
};
struct Pilot {
    int width = 0;
    std::vector<PilotPixel> half[2] = {};
};

/// The number of samples of each pixel.
using SamplesOf = std::function<uint32_t(size_t pixel)>;

/// How samples are distributed unevenly among pixels, after a pilot with as many for each. The
/// samples of a pixel alternate between two halves: sample number 2 k + h is number k of half h.
struct Allocation {
    uint32_t pilot = 0;  // samples of each pixel; 0: no allocation, all pixels get the same

    /// Decides the numbers of samples from the pilot. Empty: already decided.
    std::function<void(const Pilot& pilot, int threads)> choose_densities = {};

    /// The numbers of samples in a half, for `spp` samples per pixel on average. They grow with
    /// spp, and are the same for all pixels up to the end of the pilot.
    std::function<SamplesOf(int half, uint32_t spp)> samples = {};
};

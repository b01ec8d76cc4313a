// Samples that are not shared out evenly.
#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "common/base/vec.h"

/// What the pilot has seen of a pixel, in one half: of each channel its mean, and the sum of
/// (sample - mean)^2. The same steps as in RunningStats, of three channels at once.
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

/// How many samples of each pixel there are.
using SamplesOf = std::function<uint32_t(size_t pixel)>;

/// How samples are shared out unevenly among the pixels, after a pilot that gives all alike. Those
/// of a pixel belong to two halves by turns: sample number 2 k + h is number k of half h.
struct Allocation {
    uint32_t pilot = 0;  // samples of each pixel; 0: no allocation, all pixels get the same

    /// Decides, by the pilot. Empty: has decided.
    std::function<void(const Pilot& pilot, int threads)> share_out = {};

    /// How many there are in a half when there are `spp` a pixel on the mean. Grows with spp, and
    /// up to the pilot it is the same for all pixels.
    std::function<SamplesOf(int half, uint32_t spp)> samples = {};
};

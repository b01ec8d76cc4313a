// Samples that are not shared out evenly.
#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "common/picture/film.h"

/// How many rays the samples of each pixel took, in each half.
using RayCounts = std::vector<uint32_t>[2];

/// How many samples of each pixel there are.
using SamplesOf = std::function<uint32_t(size_t pixel)>;

/// How samples are shared out unevenly among the pixels, after a pilot that gives all alike. Those
/// of a pixel belong to two halves by turns: sample number 2 k + h is number k of half h.
struct Allocation {
    uint32_t pilot = 0;  // samples of each pixel; 0: no allocation, all pixels get the same

    /// Decides, from the film of the pilot and the rays that it took. Empty: has decided.
    std::function<void(const Film& pilot, const RayCounts& rays, int threads)> share_out = {};

    /// How many there are in a half when there are `spp` a pixel on the mean. Grows with spp, and
    /// up to the pilot it is the same for all pixels.
    std::function<SamplesOf(int half, uint32_t spp)> samples = {};
};

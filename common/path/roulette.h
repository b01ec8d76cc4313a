// When a path ends by chance (chapter 07).
#pragma once
#include "common/base/vec.h"

/// The probability with which a path of throughput beta goes on.
///
///   q = 2.5 max(beta), within [0.05, 0.95];  1 for the first few vertices
///
/// From the largest channel: no channel of beta / q is above 0.4, or beta / 0.95. Below 1, so that
/// a path that loses nothing (mirrors, total reflection) ends as well. 2.5: more adds less noise,
/// less saves more rays; of 1, 1.5, 2, 2.5 and 3 it was the most efficient in the Cornell box.
inline float survival_probability(Rgb beta, int depth) {
    if (depth < 3) return 1;
    return std::clamp(2.5f * max_component(beta), 0.05f, 0.95f);
}

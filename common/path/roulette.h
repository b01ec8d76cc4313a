// taught by chapter 08
// When a path ends by chance.
#pragma once
#include "common/base/vec.h"

/// The probability with which a path of throughput beta goes on.
///
///   q = max(beta), within [0.05, 0.95];  1 for the first few vertices
///
/// From the largest channel: no channel of beta / q is above 1, or beta / 0.95. Below 1, so that a
/// path that loses nothing (mirrors, total reflection) ends as well; not below 0.05, so that no
/// path ever counts for more than 20.
inline float survival_probability(Rgb beta, int depth) {
    if (depth < 3) return 1;
    return std::clamp(max_component(beta), 0.05f, 0.95f);
}

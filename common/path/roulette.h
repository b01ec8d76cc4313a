// taught by chapter 08
// The survival probability of Russian roulette.
#pragma once
#include "common/base/vec.h"

/// The probability q that a path of throughput beta continues.
///
///   q = max(beta), within [0.05, 1];  1 for the first few vertices
///
/// The largest channel of beta: where q is below 1, no channel of beta / q is above 1.
/// At most 1: a path that loses nothing continues up to the depth limit.
/// At least 0.05: so one survival multiplies the weight by at most 20.
inline float survival_probability(Rgb beta, int depth) {
    if (depth < 3) return 1;
    return std::clamp(max_component(beta), 0.05f, 1.0f);
}

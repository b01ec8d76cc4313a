// taught by chapter 08
// The survival probability of Russian roulette.
#pragma once
#include "common/base/vec.h"

/// The probability q that a path of throughput beta continues.
///
///   q = max(beta), within [0.05, 0.95];  1 for the first few vertices
///
/// The largest channel: so no channel of beta / q exceeds 1 (or beta / 0.95). At most 0.95, so that
/// paths that lose nothing (mirrors, total reflection) end too; at least 0.05, so that one survival
/// multiplies the weight by at most 20.
inline float survival_probability(Rgb beta, int depth) {
    if (depth < 3) return 1;
    return std::clamp(max_component(beta), 0.05f, 0.95f);
}

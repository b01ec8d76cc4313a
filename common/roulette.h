// When a path ends by chance (chapter 07).
#pragma once
#include "common/vec.h"

/// The probability with which a path of throughput beta goes on.
///
///   q = the largest channel of beta, within [0.05, 0.95];  1 for the first few vertices
///
/// Taken from the largest channel, no channel's beta / q can grow from vertex to vertex. Below 1,
/// so that a path that loses nothing (mirrors, total reflection) ends as well.
inline float survival_probability(Rgb beta, int depth) {
    if (depth < 3) return 1;
    return std::clamp(max_component(beta), 0.05f, 0.95f);
}

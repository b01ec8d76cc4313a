// taught by chapter 24
// The radius in which photons count, from pass to pass.
#pragma once
#include <cstdint>

#include "common/base/vec.h"

/// The radius of a pass, the same for all points.
///
///   (r_i+1 / r_i)^2 = (i + alpha) / (i + 1),    alpha = 2/3:    r_i ~ i^(-1/6)
///
/// After N passes bias^2 ~ r^4 ~ N^(-2/3), and variance ~ 1 / (N r^2) ~ N^(-2/3).
/// source  Hachisuka et al. 2008; Knaus, Zwicker 2011
/// tested by  "truth: radii shrink", to 1e-5
inline float radius_of(float first, uint32_t pass) {
    constexpr double alpha = 2.0 / 3;
    double r2 = 1;  // divided by the square of the first radius
    for (double i = 1; i <= pass; i++) r2 *= (i + alpha) / (i + 1);
    return first * static_cast<float>(std::sqrt(r2));
}

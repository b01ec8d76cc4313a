// taught by chapter 02
#pragma once
#include <vector>

#include "common/base/stats.h"
#include "common/path/sampler.h"

using Points = std::vector<Vec2>;  // on the unit square

/// Pair number i of a sequence of independent random numbers; each `seed` has its own sequence.
inline Vec2 random_pair(uint32_t seed, uint32_t i) {
    Sampler sampler(SamplerType::independent, seed, 1);
    sampler.start(0, i);
    return sampler.u2();
}

/// A point of stratum i of n, at position u in it. Strata have equal area 1/n, for any n.
///
///   the square is cut into about sqrt(n) columns, each as wide as its share of the n cells;
///   n = k^2 gives the k x k grid
inline Vec2 jitter_in_stratum(uint32_t i, uint32_t n, Vec2 u) {
    uint32_t columns = static_cast<uint32_t>(std::rint(std::sqrt(static_cast<double>(n))));
    uint64_t c = (uint64_t{i + 1} * columns - 1) / n;
    uint32_t first = static_cast<uint32_t>(c * n / columns);
    uint32_t last = static_cast<uint32_t>((c + 1) * n / columns);
    float rows = static_cast<float>(last - first), count = static_cast<float>(n);
    float x = (static_cast<float>(first) + rows * u.x) / count;
    float y = (static_cast<float>(i - first) + u.y) / rows;
    return {std::min(x, 0x1.fffffep-1f), std::min(y, 0x1.fffffep-1f)};
}

/// x, or the largest float below 1 where rounding made it 1: keeps coordinates in [0,1).
inline float below_1(float x) { return std::min(x, 0x1.fffffep-1f); }

/// The estimate of the integral of f over the square: (1/N) sum f(x_i).
///
/// bias 0 for points that are uniform on the square. Points of one set may depend on each other, so
/// s^2/N is NOT the variance of the estimate: measure that from the estimates of many sets.
/// tested by  "failure: s^2/N is 4.7 times the variance of 6 x 6 strata", to 2 %
template <class Function>
double estimate(const Points& points, Function f) {
    RunningStats stats;
    for (Vec2 p : points) stats.add(f(p));
    return stats.mean();
}

/// Two integrands: a dart for pi, which jumps at the edge of the circle, and a smooth function.
inline double quarter_circle(Vec2 x) {
    return double{x.x} * double{x.x} + double{x.y} * double{x.y} <= 1 ? 4 : 0;  // integral pi
}
inline double product(Vec2 x) { return double{x.x} * double{x.y}; }  // integral 1/4

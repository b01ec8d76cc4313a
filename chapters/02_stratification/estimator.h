// Chapter 02: one random sample in each of N equal parts.
#pragma once
#include <cmath>
#include <vector>

#include "common/base/stats.h"
#include "common/path/sampler.h"

namespace ch02 {

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

/// A number in interval i of n, at position u in it: strata in one dimension.
inline float jitter_in_interval(uint32_t i, uint32_t n, float u) {
    return below_1((static_cast<float>(i) + u) / static_cast<float>(n));
}

/// N-rooks (Latin hypercube): point i of n has column i, and a row that no other point has.
///
/// Each axis by itself has n strata, for any n. The rows are in random order; in ascending order
/// all points would be on the diagonal.
/// source  Shirley 1991
/// tested by  "variance: for xy that of k x k strata falls as k^-4, N-rooks keep the interaction",
///            within 5 standard errors
inline Vec2 jitter_rook(uint32_t i, uint32_t n, uint32_t seed, Vec2 u) {
    uint32_t row = permute(i, n, hash32(seed));
    return {jitter_in_interval(i, n, u.x), jitter_in_interval(row, n, u.y)};
}

enum class PointSet { uniform, jittered, rooks };

/// n points. Each seed gives other points; averaged over all seeds they are uniform on the square.
inline Points make_points(PointSet set, uint32_t n, uint32_t seed) {
    Points points;
    for (uint32_t i = 0; i < n; i++) {
        Vec2 u = random_pair(seed, i);
        switch (set) {
            case PointSet::uniform: points.push_back(u); break;
            case PointSet::jittered: points.push_back(ch02::jitter_in_stratum(i, n, u)); break;
            case PointSet::rooks: points.push_back(jitter_rook(i, n, seed, u)); break;
        }
    }
    return points;
}

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

/// A penumbra: a screen with a straight, slanted edge hides part of a square light. A point on the
/// floor, at distance p from the full shadow, sees the part of the light above the edge.
///
///   V(u) = [a u.x + b u.y < p],   u: a point of the light, uniform on the square
///   fraction seen = (p^2 - (p-a)^2 - (p-b)^2 + (p-a-b)^2) / (2ab), squares of positive bases only
///
/// tested by  "truth: the penumbra of a straight edge", to 1e-14; by counting points, within 1e-4
inline constexpr double edge_a = 0.8, edge_b = 0.6;
inline double sees_light(Vec2 u, double p) {
    return edge_a * double{u.x} + edge_b * double{u.y} < p ? 1 : 0;
}
inline double fraction_seen(double p) {
    auto square = [](double x) { return x > 0 ? x * x : 0; };
    return (square(p) - square(p - edge_a) - square(p - edge_b) + square(p - edge_a - edge_b)) /
           (2 * edge_a * edge_b);
}

}  // namespace ch02

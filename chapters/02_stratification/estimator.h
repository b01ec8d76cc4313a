// Chapter 02: points that are random and yet evenly spread.
#pragma once
#include <cmath>
#include <vector>

#include "common/base/stats.h"
#include "common/path/sampler.h"

namespace ch02 {

using Points = std::vector<Vec2>;  // on the unit square

/// Pair number i of the independent random numbers of `seed`.
inline Vec2 random_pair(uint32_t seed, uint32_t i) {
    Sampler sampler(SamplerType::independent, seed, 1);
    sampler.start(0, i);
    return sampler.u2();
}

/// Point u jittered inside stratum i of n: strata of equal area 1/n for any n.
///
///   the square is cut into about sqrt(n) columns, as wide as the number of cells in each, so that
///   n = k^2 gives the k x k grid, and no other n has to drop or repeat a sample
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

inline float below_1(float x) { return std::min(x, 0x1.fffffep-1f); }

/// The same in one dimension: interval i of n.
inline float jitter_in_interval(uint32_t i, uint32_t n, float u) {
    return below_1((static_cast<float>(i) + u) / static_cast<float>(n));
}

/// The second coordinate of the 2-D Sobol sequence as 32 bits; the first is reverse_bits(index).
///
///   bit k of the result (from the top) = sum over j of binomial(j, k) bit j of index, mod 2
///
/// Pascal's triangle mod 2 is its own quarter repeated, so that five steps multiply by all of it.
/// tested by  "truth: every dyadic box holds one of the first 2^m Sobol points"
inline uint32_t sobol_second(uint32_t index) {
    uint32_t x = reverse_bits(index);
    x ^= (x << 16) & 0xffff0000u;
    x ^= (x << 8) & 0xff00ff00u;
    x ^= (x << 4) & 0xf0f0f0f0u;
    x ^= (x << 2) & 0xccccccccu;
    x ^= (x << 1) & 0xaaaaaaaau;
    return x;
}

/// Owen's scrambling of a 32-bit fraction: each bit is flipped or not by a random function of the
/// bits above it. The points stay as evenly spread as they were, and each becomes uniform.
/// source  Laine, Karras 2011; constants: Vegdahl 2021
inline uint32_t scramble_reversed(uint32_t x, uint32_t seed) {  // x: bits reversed
    x ^= x * 0x3d20adeau;
    x = (x + seed) * ((seed >> 16) | 1u);
    x ^= x * 0x05526c56u;
    return x ^ x * 0x53a22864u;
}
inline uint32_t owen_scramble(uint32_t x, uint32_t seed) {
    return reverse_bits(scramble_reversed(reverse_bits(x), seed));
}

/// The digits of i in `base`, mirrored at the point: 6 = 110 becomes 0.011 = 3/8 in base 2.
///
/// seed  0: the digits as they are; else each is permuted by a random function of the digits
///       before it, which is Owen's scrambling in any base
/// source  van der Corput 1935; Halton 1960
/// tested by  "truth: radical inverses", "failure: Halton in bases 17 and 19 starts on a line"
inline float radical_inverse(uint32_t base, uint32_t i, uint32_t seed = 0) {
    double x = 0, place = 1;
    for (uint32_t digits = seed; i > 0 || (seed != 0 && place > 0x1p-24); i /= base) {
        uint32_t digit = seed == 0 ? i % base : permute(i % base, base, hash32(digits));
        digits = hash32(digits, i % base);
        place /= base;
        x += place * digit;
    }
    return below_1(static_cast<float>(x));
}

/// From b to a the short way round the torus, on which opposite sides of the square meet.
inline Vec2 torus_difference(Vec2 a, Vec2 b) {
    float x = a.x - b.x, y = a.y - b.y;
    return {x - std::floor(x + 0.5f), y - std::floor(y + 0.5f)};
}

inline Vec2 wrap(Vec2 p) {
    return {below_1(p.x - std::floor(p.x)), below_1(p.y - std::floor(p.y))};
}
enum class Rim { open, torus };

/// Poisson disc by dart throwing: random points, none nearer than r to another.
///
/// Ends after `max_misses` darts in a row that were too near. How many points there are is chance:
/// divide by that number. On the open square points crowd at the rim: a bias; the torus has none.
/// source  Cook 1986      tested by  "failure: Poisson discs on the open square crowd at its rim"
inline Points poisson_disc_points(float r, uint32_t max_misses, uint32_t seed,
                                  Rim rim = Rim::torus) {
    Points points;
    for (uint32_t i = 0, misses = 0; r > 0 && misses < max_misses; i++) {
        Vec2 dart = random_pair(seed, i);
        bool near = false;
        for (size_t k = 0; k < points.size() && !near; k++) {
            Vec2 d = rim == Rim::torus ? torus_difference(dart, points[k])
                                       : Vec2{dart.x - points[k].x, dart.y - points[k].y};
            near = d.x * d.x + d.y * d.y < r * r;
        }
        if (!near) points.push_back(dart);
        misses = near ? misses + 1 : 0;
    }
    return points;
}

/// The largest distance that n points on the torus can all keep: the hexagonal lattice.
inline float hexagonal_distance(uint32_t n) {
    return std::sqrt(2 / (std::sqrt(3.0f) * static_cast<float>(n)));
}

/// Relaxation: random points push each other away until none moves, or `max_steps` times. Not
/// Poisson disc: it runs towards the hexagonal lattice, which aliases.
/// tested by  "failure: points that repel each other become a lattice"
inline Points repelled_points(uint32_t n, int max_steps, uint32_t seed) {
    Points points, pushed(n);
    for (uint32_t i = 0; i < n; i++) points.push_back(random_pair(seed, i));
    float spacing = hexagonal_distance(n), reach = 2 * spacing, farthest = infinity;
    for (int step = 0; step < max_steps && farthest > 1e-3f * spacing; step++) {
        farthest = 0;
        for (uint32_t i = 0; i < n; i++) {
            Vec2 push;
            for (Vec2 other : points) {
                Vec2 d = torus_difference(points[i], other);
                float distance = std::sqrt(d.x * d.x + d.y * d.y + 1e-12f);
                float strength = std::max(0.0f, 1 - distance / reach) / distance;
                push = {push.x + strength * d.x, push.y + strength * d.y};
            }
            push = {0.2f * spacing * push.x, 0.2f * spacing * push.y};
            farthest = std::max(farthest, std::abs(push.x) + std::abs(push.y));
            pushed[i] = wrap({points[i].x + push.x, points[i].y + push.y});
        }
        points.swap(pushed);
    }
    return points;
}

enum class PointSet { uniform, jittered, rooks, poisson, repelled, halton, sobol };

/// n points of a kind (Poisson disc: about n); another seed gives others, and over all seeds the
/// points of each kind are uniform on the square.
inline Points make_points(PointSet set, uint32_t n, uint32_t seed) {
    if (set == PointSet::poisson) {
        float r = std::sqrt(0.65f / static_cast<float>(n));
        return poisson_disc_points(r, 1000, seed);
    }
    if (set == PointSet::repelled) return repelled_points(n, 100, seed);

    Points points;
    Vec2 shift = random_pair(seed, n);
    for (uint32_t i = 0; i < n; i++) {
        Vec2 u = random_pair(seed, i);
        switch (set) {
            case PointSet::jittered: points.push_back(ch02::jitter_in_stratum(i, n, u)); break;
            case PointSet::rooks: {  // one in each column, one in each row
                uint32_t row = permute(i, n, hash32(seed));
                points.push_back({jitter_in_interval(i, n, u.x), jitter_in_interval(row, n, u.y)});
                break;
            }
            case PointSet::halton: {  // shifted by chance, around the torus
                Vec2 p = {radical_inverse(2, i), radical_inverse(3, i)};
                points.push_back(wrap({p.x + shift.x, p.y + shift.y}));
                break;
            }
            case PointSet::sobol: {
                uint32_t x = owen_scramble(reverse_bits(i), hash32(seed, 1));
                uint32_t y = owen_scramble(sobol_second(i), hash32(seed, 2));
                points.push_back({to_unit_float(x), to_unit_float(y)});
                break;
            }
            default: points.push_back(u);  // uniform
        }
    }
    return points;
}

/// The estimate of the integral of f over the square: (1/N) sum f(x_i).
///
/// bias 0 for every kind. The points of a set are not independent: s^2/N is NOT the variance of the
/// estimate, only the spread of whole sets with other seeds is.
/// tested by  "failure: s^2/N is 4.7 times the variance of 6 x 6 strata"
template <class Function>
double estimate(const Points& points, Function f) {
    RunningStats stats;
    for (Vec2 p : points) stats.add(f(p));
    return stats.mean();
}

// What is estimated: an area with an edge, a smooth function, and an area light behind a screen.
inline double quarter_circle(Vec2 x) {
    return double{x.x} * double{x.x} + double{x.y} * double{x.y} <= 1 ? 4 : 0;  // integral pi
}
inline double product(Vec2 x) { return double{x.x} * double{x.y}; }  // integral 1/4

/// A penumbra: a square light above a screen with a straight, slanted edge. From a point on the
/// floor, p beyond the full shadow, point u of the light is seen when it is above the edge.
///
///   V = [a u.x + b u.y < p],   fraction seen = (p^2 - (p-a)^2 - (p-b)^2 + (p-a-b)^2) / (2ab),
///
/// each square only of a positive base.      tested by  "truth: the penumbra of a straight edge"
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

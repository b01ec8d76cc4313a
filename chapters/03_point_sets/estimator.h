// Chapter 03: point sets that are more evenly spread than strata, in two and more dimensions.
#pragma once
#include <cmath>
#include <utility>
#include <vector>

#include "common/path/points.h"
#include "common/path/sampler.h"

namespace ch03 {

/// The shortest vector from b to a on the torus: the unit square with opposite sides joined.
inline Vec2 torus_difference(Vec2 a, Vec2 b) {
    float x = a.x - b.x, y = a.y - b.y;
    return {x - std::floor(x + 0.5f), y - std::floor(y + 0.5f)};
}

/// The point of the unit square that is p on the torus.
inline Vec2 wrap(Vec2 p) {
    return {below_1(p.x - std::floor(p.x)), below_1(p.y - std::floor(p.y))};
}

enum class Rim { open, torus };

/// Poisson disc samples by dart throwing: random points, no two of them nearer than r.
///
/// Ends after `max_misses` rejected darts in a row. The number of points is random, and estimates
/// divide by it. Biased on the open square, where points crowd at the rim; unbiased on the torus.
/// source  Cook 1986
/// tested by  "failure: Poisson discs on the open square crowd at its rim",
///            torus: within 5 standard errors; open square: pi within 0.05
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

/// The largest distance that n points on the torus can keep from each other: a hexagonal lattice.
inline float hexagonal_distance(uint32_t n) {
    return std::sqrt(2 / (std::sqrt(3.0f) * static_cast<float>(n)));
}

/// The sum of the repulsions of p by all points nearer than `reach`, each 1 - distance / reach.
inline Vec2 repulsion(const Points& points, Vec2 p, float reach) {
    Vec2 push;
    for (Vec2 other : points) {
        Vec2 d = torus_difference(p, other);
        float distance = std::sqrt(d.x * d.x + d.y * d.y + 1e-12f);
        float strength = std::max(0.0f, 1 - distance / reach) / distance;
        push = {push.x + strength * d.x, push.y + strength * d.y};
    }
    return push;
}

/// Relaxation: random points push each other away until none moves, or `max_steps` times.
///
/// This is not Poisson disc sampling: the points tend to a hexagonal lattice, which aliases.
/// tested by  "failure: points that repel each other become a lattice",
///            mean distance to the nearest point above 0.9 of the lattice's
inline Points repelled_points(uint32_t n, int max_steps, uint32_t seed) {
    Points points, moved(n);
    for (uint32_t i = 0; i < n; i++) points.push_back(random_pair(seed, i));
    float spacing = hexagonal_distance(n), farthest = infinity;
    for (int step = 0; step < max_steps && farthest > 1e-3f * spacing; step++) {
        farthest = 0;
        for (uint32_t i = 0; i < n; i++) {
            Vec2 push = repulsion(points, points[i], 2 * spacing);
            push = {0.2f * spacing * push.x, 0.2f * spacing * push.y};
            farthest = std::max(farthest, std::abs(push.x) + std::abs(push.y));
            moved[i] = wrap({points[i].x + push.x, points[i].y + push.y});
        }
        points.swap(moved);
    }
    return points;
}

/// The digits of i in `base`, mirrored at the point: 6 = 110 becomes 0.011 = 3/8 in base 2.
///
/// seed  0: plain digits; else a random permutation of each digit that depends on the digits
///       before it: Owen scrambling in any base
/// source  van der Corput 1935; Halton 1960
/// tested by  "truth: radical inverses", base 2 exactly, base 3 within 1e-7
/// tested by  "failure: Halton in bases 17 and 19 starts on a line", correlation above 0.94,
///            scrambled below 0.3
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

/// n Halton points: bases 2 and 3 for the first pair of dimensions, 5 and 7 for the second. All
/// are shifted by one random vector on the torus, which makes each of them uniform.
/// tested by  "variance: Sobol points as with explicit nested scrambling, ...", to 20 %
inline Points halton_points(uint32_t pair, uint32_t n, uint32_t seed) {
    constexpr uint32_t base[] = {2, 3, 5, 7};
    Points points;
    Vec2 shift = random_pair(seed, n + pair);
    for (uint32_t i = 0; i < n; i++) {
        Vec2 p = {radical_inverse(base[2 * pair], i), radical_inverse(base[2 * pair + 1], i)};
        points.push_back(wrap({p.x + shift.x, p.y + shift.y}));
    }
    return points;
}

/// The second coordinate of the 2-D Sobol sequence as 32 bits; the first is reverse_bits(index).
///
///   bit k of the result (from the top) = sum over j of binomial(j, k) bit j of index, mod 2
///
/// Steps: each adds the higher half of a block of bits to the lower, with halves of 16 ... 1 bits.
/// tested by  "identity: scrambled and shuffled points fill the same boxes, ...", exactly
inline uint32_t sobol_second(uint32_t index) {
    uint32_t x = reverse_bits(index);
    x ^= (x << 16) & 0xffff0000u;
    x ^= (x << 8) & 0xff00ff00u;
    x ^= (x << 4) & 0xf0f0f0f0u;
    x ^= (x << 2) & 0xccccccccu;
    x ^= (x << 1) & 0xaaaaaaaau;
    return x;
}

/// Owen scrambling of a 32-bit fraction: a random function of the bits above it decides whether a
/// bit is flipped. Points stay as evenly spread as before, and each becomes uniform.
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

/// The first n points of the 2-D Sobol sequence, scrambled.
/// tested by  "variance: Sobol points as with explicit nested scrambling, ...", to 15 %
inline Points sobol_points(uint32_t n, uint32_t seed) {
    Points points;
    for (uint32_t i = 0; i < n; i++) {
        uint32_t x = owen_scramble(reverse_bits(i), hash32(seed, 1));
        uint32_t y = owen_scramble(sobol_second(i), hash32(seed, 2));
        points.push_back({to_unit_float(x), to_unit_float(y)});
    }
    return points;
}

enum class PointSet { uniform, jittered, poisson, repelled, halton, sobol };

/// n points of a kind (Poisson disc: about n). Each seed gives other points; averaged over all
/// seeds they are uniform on the square.
inline Points make_points(PointSet set, uint32_t n, uint32_t seed) {
    if (set == PointSet::poisson)
        return poisson_disc_points(std::sqrt(0.65f / static_cast<float>(n)), 1000, seed);
    if (set == PointSet::repelled) return repelled_points(n, 100, seed);
    if (set == PointSet::halton) return halton_points(0, n, seed);
    if (set == PointSet::sobol) return sobol_points(n, seed);

    Points points;
    for (uint32_t i = 0; i < n; i++) {
        Vec2 u = random_pair(seed, i);
        points.push_back(set == PointSet::jittered ? jitter_in_stratum(i, n, u) : u);
    }
    return points;
}

/// The points in a random order, every order equally likely.      source  Fisher, Yates 1938
inline Points shuffled(Points points, uint32_t seed) {
    for (size_t left = points.size(); left > 1; left--) {
        double u = double{random_pair(seed, static_cast<uint32_t>(left)).x};
        std::swap(points[left - 1], points[static_cast<size_t>(u * static_cast<double>(left))]);
    }
    return points;
}

/// The second pair of dimensions, z and w, of points in four.
///
/// Halton uses two more bases. The other kinds take a second set of points in a random order, so
/// that (x, y) and (z, w) are paired at random. In the same order, both pairs would reach their
/// strata at the same time, and z would be correlated with x.
/// tested by  "variance: two pairs in a random order have the variance of random matching",
///            within 5 standard errors
/// tested by  "failure: two Sobol sets in the same order have a variance of 1/248 ...", to 3 %
inline Points second_pair(PointSet set, uint32_t n, uint32_t seed) {
    if (set == PointSet::halton) return halton_points(1, n, seed);
    return shuffled(make_points(set, n, hash32(seed, 1)), hash32(seed, 2));
}

/// The estimate of the integral of f over four dimensions: (1/N) sum f(xy_i, zw_i).
template <class Function>
double estimate_4d(const Points& xy, const Points& zw, Function f) {
    RunningStats stats;
    for (size_t i = 0; i < std::min(xy.size(), zw.size()); i++) stats.add(f(xy[i], zw[i]));
    return stats.mean();
}

}  // namespace ch03

// in part taught by chapters 02 (strata) and 03 (Sobol points); all chapters draw from the Sampler
// Random numbers as a pure function of (seed, pixel, sample, dimension).
#pragma once
#include <bit>
#include <cmath>
#include <cstdint>

#include "common/base/hash.h"
#include "common/base/vec.h"

/// Scrambles 64 bits; a bijection.      source  Stafford 2011, "Mix13"; Steele, Lea, Flood 2014
inline uint64_t hash64(uint64_t x) {
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

/// The top 24 bits as a number in [0,1). Converting all 32 would round the largest to 1.
inline float to_unit_float(uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24f; }

/// Combines two numbers in [0,1) of 24 bits to one of 48 bits, to choose among millions.
inline double to_unit_double(Vec2 u) { return double{u.x} + 0x1p-24 * double{u.y}; }

/// The random numbers in [0,1) of a light sample: they choose the light, and a point on it.
struct LightNumbers {
    double light;
    Vec2 point;
};
/// The random numbers of RIS: they draw candidates, choose one of them, and a point on it.
struct ResamplingNumbers {
    double candidates;
    float choice;
    Vec2 point;
};
/// The random numbers of two light samples: they draw candidates, choose two, and a point on each.
struct TwoLightNumbers {
    double candidates;
    float choice;
    Vec2 first, second;
};

inline uint32_t reverse_bits(uint32_t x) {
    x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
    x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
    x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
    return __builtin_bswap32(x);
}

/// The second coordinate of the 2-D Sobol sequence as 32 bits; the first is reverse_bits(index).
///
///   bit k of the result (from the top) = sum over j of binomial(j, k) bit j of index, mod 2
///
/// Steps: each adds the higher half of a block of bits to the lower, with halves of 16 ... 1 bits.
/// tested by  "truth: every dyadic box holds one of the first 2^m Sobol points", exactly
inline uint32_t sobol_second(uint32_t index) {
    uint32_t x = reverse_bits(index);
    x ^= (x << 16) & 0xffff0000u;
    x ^= (x << 8) & 0xff00ff00u;
    x ^= (x << 4) & 0xf0f0f0f0u;
    x ^= (x << 2) & 0xccccccccu;
    x ^= (x << 1) & 0xaaaaaaaau;
    return x;
}

/// sobol_second with the bits of argument and result reversed: the same steps with shifts reversed.
/// tested by  "identity: Sobol's second coordinate from either end"
inline uint32_t sobol_second_reversed(uint32_t x) {
    x ^= (x >> 16) & 0x0000ffffu;
    x ^= (x >> 8) & 0x00ff00ffu;
    x ^= (x >> 4) & 0x0f0f0f0fu;
    x ^= (x >> 2) & 0x33333333u;
    x ^= (x >> 1) & 0x55555555u;
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

/// The position of i in a random permutation of 0 .. n-1, without a table.
///
///   a bijection of 0 .. 2^k-1, 2^k >= n, in rounds of  i = odd i + any mod 2^k,  i ^= i >> k/2;
///   repeated until the result is below n, then rotated so that each position is equally likely
///
/// source  cycle walking: Black, Rogaway 2002; for sampling: Kensler 2013
/// tested by  "truth: permute is a permutation for every n, and each place equally likely"
inline uint32_t permute(uint32_t i, uint32_t n, uint32_t seed) {
    uint32_t mask = std::bit_ceil(n) - 1;
    int half = (std::bit_width(mask) + 1) / 2;
    do {
        for (uint32_t round = 1; round <= 4; round++) {
            uint32_t key = hash32(seed + round);
            i = (i * (key | 1) + (key >> 16)) & mask;
            i ^= i >> half;
        }
    } while (i >= n);
    return (i + seed % n) % n;
}

enum class SamplerType : uint8_t { independent, stratified, sobol };

/// The random numbers in [0,1) of one path, in the order in which it uses them.
///
/// independent  independent numbers
/// stratified   each pair of dimensions: the samples of a pixel fill `spp` strata, in random order
/// sobol        each pair of dimensions: Owen-scrambled 2-D Sobol points, in random order
///
/// The same (seed, pixel, sample) gives the same numbers on any machine, whatever the threads.
/// All numbers of a pixel come from one key, a bijection of (seed, pixel): no two pixels have the
/// same key, whatever their seeds. source  PCG: O'Neill 2014; shuffled, scrambled Sobol
/// pairs: Burley 2020
class Sampler {
public:
    Sampler(SamplerType type, uint32_t seed, uint32_t spp) : type_(type), seed_(seed), spp_(spp) {}

    /// Starts sample `sample` of pixel number `pixel`.
    void start(uint32_t pixel, uint32_t sample) {
        key_ = hash64((uint64_t{seed_} << 32 | pixel) + 0x9e3779b97f4a7c15u);  // of 0: 0
        sample_ = sample;
        if (type_ != SamplerType::independent) reversed_sample_ = reverse_bits(sample);
        dimension_ = 0;
        state_ = hash64(key_ + sample);
    }

    /// Continues with the numbers of this dimension, a multiple of 8, however many numbers were
    /// drawn before.
    void jump(uint32_t dimension) { dimension_ = dimension; }

    float u1() {
        if (type_ == SamplerType::independent) return to_unit_float(random_bits());
        return u2().x;
    }
    Vec2 u2() {
        if (type_ == SamplerType::sobol) return sobol();
        if (type_ == SamplerType::stratified) return stratified();
        return independent();
    }

private:
    /// The seed of point set `number` of this pixel: different for each set.
    uint32_t key_of_set(uint32_t number) const {
        uint32_t high = static_cast<uint32_t>(key_ >> 32), low = static_cast<uint32_t>(key_);
        return hash32(low + 0x632be5abu * number) ^ high;
    }
    uint32_t random_bits() {
        state_ = state_ * 6364136223846793005u + 1442695040888963407u;
        uint32_t bits = static_cast<uint32_t>(((state_ >> 18) ^ state_) >> 27);
        return std::rotr(bits, static_cast<int>(state_ >> 59));
    }
    Vec2 independent() { return Vec2{to_unit_float(random_bits()), to_unit_float(random_bits())}; }
    [[gnu::noinline]] Vec2 stratified() {
        uint32_t set = key_of_set(dimension_++ + (sample_ / spp_ << 16));
        return jitter_in_stratum(permute(sample_ % spp_, spp_, set), spp_, independent());
    }
    /// The point of the next pair of dimensions; u1() uses its first coordinate only.
    Vec2 sobol() {
        size_t i = dimension_ % at_once;
        if (i == 0) draw_sobol();
        dimension_++;
        return {sobol_x_[i], sobol_y_[i]};
    }
    /// The points of the next 8 pairs of dimensions, so that the compiler vectorizes the loop.
    /// index is owen_scramble(sample), x owen_scramble(reverse_bits(index)), y
    /// owen_scramble(sobol_second(index)), without pairs of reversals that cancel.
    [[gnu::noinline]] void draw_sobol() {
        for (uint32_t i = 0; i < at_once; i++) {
            uint32_t set = key_of_set(dimension_ + i);
            uint32_t index = reverse_bits(scramble_reversed(reversed_sample_, set));
            uint32_t x = scramble_reversed(index, set * 0x9e3779b1u + 1);
            uint32_t y = scramble_reversed(sobol_second_reversed(index), set * 0x85ebca77u + 2);
            sobol_x_[i] = to_unit_float(reverse_bits(x));
            sobol_y_[i] = to_unit_float(reverse_bits(y));
        }
    }

    static constexpr uint32_t at_once = 8;

    SamplerType type_;
    uint32_t seed_, spp_;
    uint32_t sample_ = 0, reversed_sample_ = 0, dimension_ = 0;
    uint64_t key_ = 0, state_ = 0;
    float sobol_x_[at_once], sobol_y_[at_once];
};

/// Draws the numbers that choosing two of N lights among M candidates needs.
inline TwoLightNumbers two_light_numbers(Sampler& sampler, size_t N, int M) {
    return {N > static_cast<size_t>(M) ? to_unit_double(sampler.u2()) : 0, N > 2 ? sampler.u1() : 0,
            sampler.u2(), N > 1 ? sampler.u2() : Vec2{}};
}

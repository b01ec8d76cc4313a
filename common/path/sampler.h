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

/// The position of i in a random permutation of 0 .. n-1, without a table.
///
///   a bijection of 0 .. 2^k-1, 2^k >= n, in rounds of  i = odd i + any mod 2^k,  i ^= i >> k/2;
///   repeated until the result is below n, then rotated so that each position is equally likely
///
/// source  cycle walking: Black, Rogaway 2002; for sampling: Kensler 2013
/// tested by  "truth: permute is a permutation for every n, and each place equally likely"
uint32_t permute(uint32_t i, uint32_t n, uint32_t seed);

/// The second coordinate of the 2-D Sobol sequence (chapter 03), with the bits of index and result
/// reversed: the same steps with shifts reversed.
/// tested by  "identity: Sobol's second coordinate from either end"
uint32_t sobol_second_reversed(uint32_t index);

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
    Vec2 stratified();
    /// The point of the next pair of dimensions; u1() uses its first coordinate only.
    Vec2 sobol() {
        size_t i = dimension_ % at_once;
        if (i == 0) draw_sobol();
        dimension_++;
        return {sobol_x_[i], sobol_y_[i]};
    }
    /// Computes the points of the next 8 pairs of dimensions.
    void draw_sobol();

    static constexpr uint32_t at_once = 8;

    SamplerType type_;
    uint32_t seed_, spp_;
    uint32_t sample_ = 0, dimension_ = 0;
    uint64_t key_ = 0, state_ = 0;
    float sobol_x_[at_once], sobol_y_[at_once];
};

/// Draws the numbers that choosing two of N lights among M candidates needs.
inline TwoLightNumbers two_light_numbers(Sampler& sampler, size_t N, int M) {
    return {N > static_cast<size_t>(M) ? to_unit_double(sampler.u2()) : 0, N > 2 ? sampler.u1() : 0,
            sampler.u2(), N > 1 ? sampler.u2() : Vec2{}};
}

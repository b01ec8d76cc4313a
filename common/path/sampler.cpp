// in part taught by chapter 03 (scrambling)
#include "common/path/sampler.h"

#include "common/path/points.h"

uint32_t sobol_second_reversed(uint32_t x) {
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

uint32_t permute(uint32_t i, uint32_t n, uint32_t seed) {
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

Vec2 Sampler::stratified() {
    uint32_t set = key_of_set(dimension_++ + (sample_ / spp_ << 16));
    return jitter_in_stratum(permute(sample_ % spp_, spp_, set), spp_, independent());
}

/// The points of the next 8 pairs of dimensions, so that the compiler vectorizes the loop.
/// index is owen_scramble(sample), x owen_scramble(reverse_bits(index)), y
/// owen_scramble(sobol_second(index)), without pairs of reversals that cancel.
void Sampler::draw_sobol() {
    uint32_t reversed = reverse_bits(sample_);
    for (uint32_t i = 0; i < at_once; i++) {
        uint32_t set = key_of_set(dimension_ + i);
        uint32_t index = reverse_bits(scramble_reversed(reversed, set));
        uint32_t x = scramble_reversed(index, set * 0x9e3779b1u + 1);
        uint32_t y = scramble_reversed(sobol_second_reversed(index), set * 0x85ebca77u + 2);
        sobol_x_[i] = to_unit_float(reverse_bits(x));
        sobol_y_[i] = to_unit_float(reverse_bits(y));
    }
}

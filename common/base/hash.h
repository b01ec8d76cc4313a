// Hashes of small numbers.
#pragma once
#include <cstdint>

/// Scrambles the bits of x; a bijection.      source  Wellons 2018, "lowbias32"
inline uint32_t hash32(uint32_t x) {
    x = (x ^ (x >> 16)) * 0x7feb352du;
    x = (x ^ (x >> 15)) * 0x846ca68bu;
    return x ^ (x >> 16);
}
inline uint32_t hash32(uint32_t a, uint32_t b) { return hash32(a ^ hash32(b + 0x9e3779b9u)); }

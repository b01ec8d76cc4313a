// Many floats at once, by the compiler's vector types: as many as one instruction of the processor
// works on. Arithmetic goes lane by lane, with the rounding of single floats, so that any number of
// lanes finds the same hits.
#pragma once
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#ifdef __AVX2__
#include <immintrin.h>
#endif

#if defined(__AVX512F__) && defined(__AVX512DQ__)
inline constexpr int lanes = 16;
using LaneOrder = uint64_t;  // lane k of the result is lane (order >> 4 k) & 15 of the source
#elif defined(__AVX2__) && defined(__FMA__)
inline constexpr int lanes = 8;
using LaneOrder = uint32_t;
#else
inline constexpr int lanes = 4;
using LaneOrder = uint32_t;
#endif
using Floats = float __attribute__((vector_size(4 * lanes)));
using Ints = int32_t __attribute__((vector_size(4 * lanes)));

/// Four of them, on any processor.
using Float4 = float __attribute__((vector_size(16)));
using Int4 = int32_t __attribute__((vector_size(16)));

inline Floats splat(float a) { return a - Floats{}; }
template <typename Vector, typename Number>
Vector loaded(const Number* p) {
    Vector a;
    std::memcpy(&a, p, sizeof a);
    return a;
}
inline Floats load(const float* p) { return loaded<Floats>(p); }
inline Ints load(const uint32_t* p) { return loaded<Ints>(p); }
inline void store(Floats a, float* p) { std::memcpy(p, &a, sizeof a); }
inline void store(Ints a, uint32_t* p) { std::memcpy(p, &a, sizeof a); }

/// a < b ? a : b, so that b comes back when either is NaN; max likewise.
inline Floats min(Floats a, Floats b) { return a < b ? a : b; }
inline Floats max(Floats a, Floats b) { return a > b ? a : b; }
inline Floats abs(Floats a) { return std::bit_cast<Floats>(std::bit_cast<Ints>(a) & 0x7fffffff); }

// What no operator does, or not as fast:
//   multiply_subtract        a b - c, with one rounding where the processor has that
//   less, less_equal, equal  bit k is set where this holds in lane k; not where either is NaN
//   lanes_of                 the numbers of the lanes in an order
//   permute                  lane k is lane from[k] of a
//   compress                 moves the lanes whose bits are set to the front, in their order
#if defined(__AVX512F__) && defined(__AVX512DQ__)

inline Floats multiply_subtract(Floats a, Floats b, Floats c) { return _mm512_fmsub_ps(a, b, c); }
inline uint32_t less(Floats a, Floats b) { return _mm512_cmp_ps_mask(a, b, _CMP_LT_OQ); }
inline uint32_t less_equal(Floats a, Floats b) { return _mm512_cmp_ps_mask(a, b, _CMP_LE_OQ); }
inline uint32_t equal(Ints a, uint32_t b) {
    return _mm512_cmpeq_epi32_mask(std::bit_cast<__m512i>(a),
                                   _mm512_set1_epi32(static_cast<int>(b)));
}
inline Ints lanes_of(LaneOrder order) {
    int low = static_cast<int>(order), high = static_cast<int>(order >> 32);
    return Ints{low,  low,  low,  low,  low,  low,  low,  low,
                high, high, high, high, high, high, high, high} >>
           Ints{0, 4, 8, 12, 16, 20, 24, 28, 0, 4, 8, 12, 16, 20, 24, 28};
}
inline Ints permute(Ints a, Ints from) {
    constexpr __mmask16 all_lanes = 0xffff;  // the form without a mask makes g++ 12 warn
    return std::bit_cast<Ints>(_mm512_maskz_permutexvar_epi32(
        all_lanes, std::bit_cast<__m512i>(from), std::bit_cast<__m512i>(a)));
}
inline Ints compress(Ints a, uint32_t mask) {
    return std::bit_cast<Ints>(
        _mm512_maskz_compress_epi32(static_cast<__mmask16>(mask), std::bit_cast<__m512i>(a)));
}

#else

#if defined(__AVX2__) && defined(__FMA__)
inline Floats multiply_subtract(Floats a, Floats b, Floats c) { return _mm256_fmsub_ps(a, b, c); }
inline uint32_t mask_of(Ints comparison) {
    return static_cast<uint32_t>(_mm256_movemask_ps(std::bit_cast<__m256>(comparison)));
}
inline Ints permute(Ints a, Ints from) {
    return std::bit_cast<Ints>(
        _mm256_permutevar8x32_epi32(std::bit_cast<__m256i>(a), std::bit_cast<__m256i>(from)));
}
#else
inline Floats multiply_subtract(Floats a, Floats b, Floats c) { return a * b - c; }
inline uint32_t mask_of(Ints comparison) {
    Ints bits = comparison & Ints{1, 2, 4, 8};
    return static_cast<uint32_t>(bits[0] | bits[1] | bits[2] | bits[3]);
}
inline Ints permute(Ints a, Ints from) {
    return Ints{a[from[0]], a[from[1]], a[from[2]], a[from[3]]};
}
#endif
inline uint32_t less(Floats a, Floats b) { return mask_of(a < b); }
inline uint32_t less_equal(Floats a, Floats b) { return mask_of(a <= b); }
inline uint32_t equal(Ints a, uint32_t b) { return mask_of(a == static_cast<int32_t>(b)); }
inline Ints lanes_of(LaneOrder order) {
    Ints shift;
    for (int k = 0; k < lanes; k++) shift[k] = 4 * k;
    return (Ints{} + static_cast<int>(order)) >> shift & (lanes - 1);
}
inline constexpr auto set_bits = [] {  // of each mask
    std::array<LaneOrder, 1 << lanes> orders = {};
    for (uint32_t mask = 0; mask < orders.size(); mask++) {
        int n = 0;
        for (int k = 0; k < lanes; k++) {
            if (mask >> k & 1) orders[mask] |= static_cast<LaneOrder>(k << 4 * n++);
        }
    }
    return orders;
}();
inline Ints compress(Ints a, uint32_t mask) { return permute(a, lanes_of(set_bits[mask])); }

#endif

inline Floats permute(Floats a, Ints from) {
    return std::bit_cast<Floats>(permute(std::bit_cast<Ints>(a), from));
}
inline Floats compress(Floats a, uint32_t mask) {
    return std::bit_cast<Floats>(compress(std::bit_cast<Ints>(a), mask));
}

// Many floats at once: 16 with AVX-512, 8 with AVX2, twice 4 in WebAssembly, elsewhere plain loops
// over 8. Each instruction that chapter 06 needs is named here once. The arithmetic is that of
// single floats, lane by lane, with the same rounding, so that all of them give the same hits.
#pragma once
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#ifdef __AVX2__
#include <immintrin.h>
#elif defined(__wasm_simd128__)
#include <wasm_simd128.h>
#endif

/// Four floats, or ints, that are worked on at once; + - * / < and so on go lane by lane.
using Float4 = float __attribute__((vector_size(16)));
using Int4 = int32_t __attribute__((vector_size(16)));

#if defined(__AVX512F__) && defined(__AVX512DQ__)

inline constexpr int lanes = 16;
using LaneOrder = uint64_t;  // lane k of the result is lane (order >> 4 k) & 15 of the source
inline constexpr __mmask16 all_lanes = 0xffff;  // the forms without a mask make g++ 12 warn
struct Floats {
    __m512 v;
};
struct Ints {
    __m512i v;
};

inline Floats splat(float a) { return {_mm512_set1_ps(a)}; }
inline Floats load(const float* p) { return {_mm512_load_ps(p)}; }
inline Ints load(const uint32_t* p) { return {_mm512_load_si512(p)}; }
inline void store(Floats a, float* p) { _mm512_storeu_ps(p, a.v); }
inline void store(Ints a, uint32_t* p) { _mm512_storeu_si512(p, a.v); }
/// a b - c with one rounding.
inline Floats multiply_subtract(Floats a, Floats b, Floats c) {
    return {_mm512_fmsub_ps(a.v, b.v, c.v)};
}
/// a < b ? a : b, so that b comes back when either is NaN; max likewise.
inline Floats min(Floats a, Floats b) { return {_mm512_maskz_min_ps(all_lanes, a.v, b.v)}; }
inline Floats max(Floats a, Floats b) { return {_mm512_maskz_max_ps(all_lanes, a.v, b.v)}; }
inline Floats abs(Floats a) { return {_mm512_abs_ps(a.v)}; }
/// The larger of |a| and |b|.
inline Floats max_abs(Floats a, Floats b) { return {_mm512_range_ps(a.v, b.v, 0b1011)}; }
/// Bit k is set where lane k of a is less than (or equal to) that of b; not where either is NaN.
inline uint32_t less(Floats a, Floats b) { return _mm512_cmp_ps_mask(a.v, b.v, _CMP_LT_OQ); }
inline uint32_t less_equal(Floats a, Floats b) { return _mm512_cmp_ps_mask(a.v, b.v, _CMP_LE_OQ); }
inline uint32_t equal(Ints a, uint32_t b) {
    return _mm512_cmpeq_epi32_mask(a.v, _mm512_set1_epi32(static_cast<int>(b)));
}
inline Ints lanes_of(LaneOrder order) {
    // The lower half of the order goes to the lower eight lanes.
    const __m512i shifts =
        _mm512_setr_epi32(0, 4, 8, 12, 16, 20, 24, 28, 0, 4, 8, 12, 16, 20, 24, 28);
    __m512i halves = _mm512_maskz_set1_epi32(0x00ff, static_cast<int>(order));
    halves = _mm512_mask_set1_epi32(halves, 0xff00, static_cast<int>(order >> 32));
    return {_mm512_maskz_srlv_epi32(all_lanes, halves, shifts)};
}
inline Floats permute(Floats a, Ints from) {
    return {_mm512_maskz_permutexvar_ps(all_lanes, from.v, a.v)};
}
inline Ints permute(Ints a, Ints from) {
    return {_mm512_maskz_permutexvar_epi32(all_lanes, from.v, a.v)};
}
/// Moves the lanes whose bits are set to the front, in their order.
inline Floats compress(Floats a, uint32_t mask) {
    return {_mm512_maskz_compress_ps(static_cast<__mmask16>(mask), a.v)};
}
inline Ints compress(Ints a, uint32_t mask) {
    return {_mm512_maskz_compress_epi32(static_cast<__mmask16>(mask), a.v)};
}

#else

inline constexpr int lanes = 8;
using LaneOrder = uint32_t;

namespace simd_details {
/// For each mask: its set bits as a LaneOrder.
inline constexpr auto set_bits = [] {
    std::array<LaneOrder, 256> orders = {};
    for (uint32_t mask = 0; mask < 256; mask++) {
        for (uint32_t k = 0, n = 0; k < 8; k++) {
            if (mask >> k & 1) orders[mask] |= k << 4 * n++;
        }
    }
    return orders;
}();
}  // namespace simd_details

#ifdef __AVX2__

struct Floats {
    __m256 v;
};
struct Ints {
    __m256i v;
};

inline Floats splat(float a) { return {_mm256_set1_ps(a)}; }
inline Floats load(const float* p) { return {_mm256_load_ps(p)}; }
inline Ints load(const uint32_t* p) {
    return {_mm256_load_si256(reinterpret_cast<const __m256i*>(p))};
}
inline void store(Floats a, float* p) { _mm256_storeu_ps(p, a.v); }
inline void store(Ints a, uint32_t* p) { _mm256_storeu_si256(reinterpret_cast<__m256i*>(p), a.v); }
#ifdef __FMA__
inline Floats multiply_subtract(Floats a, Floats b, Floats c) {
    return {_mm256_fmsub_ps(a.v, b.v, c.v)};
}
#else
inline Floats multiply_subtract(Floats a, Floats b, Floats c) { return {a.v * b.v - c.v}; }
#endif
inline Floats min(Floats a, Floats b) { return {_mm256_min_ps(a.v, b.v)}; }
inline Floats max(Floats a, Floats b) { return {_mm256_max_ps(a.v, b.v)}; }
inline Floats abs(Floats a) { return {_mm256_andnot_ps(_mm256_set1_ps(-0.0f), a.v)}; }
inline Floats max_abs(Floats a, Floats b) { return max(abs(a), abs(b)); }
inline uint32_t less(Floats a, Floats b) {
    return static_cast<uint32_t>(_mm256_movemask_ps(_mm256_cmp_ps(a.v, b.v, _CMP_LT_OQ)));
}
inline uint32_t less_equal(Floats a, Floats b) {
    return static_cast<uint32_t>(_mm256_movemask_ps(_mm256_cmp_ps(a.v, b.v, _CMP_LE_OQ)));
}
inline uint32_t equal(Ints a, uint32_t b) {
    __m256i same = _mm256_cmpeq_epi32(a.v, _mm256_set1_epi32(static_cast<int>(b)));
    return static_cast<uint32_t>(_mm256_movemask_ps(_mm256_castsi256_ps(same)));
}
inline Ints lanes_of(LaneOrder order) {
    return {_mm256_srlv_epi32(_mm256_set1_epi32(static_cast<int>(order)),
                              _mm256_setr_epi32(0, 4, 8, 12, 16, 20, 24, 28))};
}
inline Floats permute(Floats a, Ints from) { return {_mm256_permutevar8x32_ps(a.v, from.v)}; }
inline Ints permute(Ints a, Ints from) { return {_mm256_permutevar8x32_epi32(a.v, from.v)}; }

#elif defined(__wasm_simd128__)

struct Floats {
    v128_t low, high;
};
struct Ints {
    v128_t low, high;
};

inline Floats splat(float a) { return {wasm_f32x4_splat(a), wasm_f32x4_splat(a)}; }
inline Floats load(const float* p) { return {wasm_v128_load(p), wasm_v128_load(p + 4)}; }
inline Ints load(const uint32_t* p) { return {wasm_v128_load(p), wasm_v128_load(p + 4)}; }
inline void store(Floats a, float* p) { wasm_v128_store(p, a.low), wasm_v128_store(p + 4, a.high); }
inline void store(Ints a, uint32_t* p) {
    wasm_v128_store(p, a.low), wasm_v128_store(p + 4, a.high);
}
inline Floats operator+(Floats a, Floats b) {
    return {wasm_f32x4_add(a.low, b.low), wasm_f32x4_add(a.high, b.high)};
}
inline Floats operator-(Floats a, Floats b) {
    return {wasm_f32x4_sub(a.low, b.low), wasm_f32x4_sub(a.high, b.high)};
}
inline Floats operator*(Floats a, Floats b) {
    return {wasm_f32x4_mul(a.low, b.low), wasm_f32x4_mul(a.high, b.high)};
}
inline Floats operator/(Floats a, Floats b) {
    return {wasm_f32x4_div(a.low, b.low), wasm_f32x4_div(a.high, b.high)};
}
inline Floats multiply_subtract(Floats a, Floats b, Floats c) { return a * b - c; }
// pmin(b, a) is a < b ? a : b.
inline Floats min(Floats a, Floats b) {
    return {wasm_f32x4_pmin(b.low, a.low), wasm_f32x4_pmin(b.high, a.high)};
}
inline Floats max(Floats a, Floats b) {
    return {wasm_f32x4_pmax(b.low, a.low), wasm_f32x4_pmax(b.high, a.high)};
}
inline Floats abs(Floats a) { return {wasm_f32x4_abs(a.low), wasm_f32x4_abs(a.high)}; }
inline Floats max_abs(Floats a, Floats b) { return max(abs(a), abs(b)); }
namespace simd_details {
inline uint32_t mask_of(v128_t low, v128_t high) {
    return static_cast<uint32_t>(wasm_i32x4_bitmask(low) | wasm_i32x4_bitmask(high) << 4);
}
/// Lane k of the result is lane from[k] of both halves: byte by byte, where a byte that is not in a
/// half comes out of it as 0.
inline v128_t permute(v128_t low, v128_t high, v128_t from) {
    v128_t bytes = wasm_i32x4_add(wasm_i32x4_mul(from, wasm_i32x4_splat(0x04040404)),
                                  wasm_i32x4_splat(0x03020100));
    return wasm_v128_or(wasm_i8x16_swizzle(low, bytes),
                        wasm_i8x16_swizzle(high, wasm_i8x16_sub(bytes, wasm_i8x16_splat(16))));
}
}  // namespace simd_details
inline uint32_t less(Floats a, Floats b) {
    return simd_details::mask_of(wasm_f32x4_lt(a.low, b.low), wasm_f32x4_lt(a.high, b.high));
}
inline uint32_t less_equal(Floats a, Floats b) {
    return simd_details::mask_of(wasm_f32x4_le(a.low, b.low), wasm_f32x4_le(a.high, b.high));
}
inline uint32_t equal(Ints a, uint32_t b) {
    v128_t all = wasm_u32x4_splat(b);
    return simd_details::mask_of(wasm_i32x4_eq(a.low, all), wasm_i32x4_eq(a.high, all));
}
/// Each lane keeps its digit of the order, moves it to the top, and all of them to the bottom.
inline Ints lanes_of(LaneOrder order) {
    v128_t all = wasm_u32x4_splat(order);
    v128_t low = wasm_v128_and(all, wasm_u32x4_const(0x7, 0x70, 0x700, 0x7000));
    v128_t high = wasm_v128_and(all, wasm_u32x4_const(0x70000, 0x700000, 0x7000000, 0x70000000));
    low = wasm_i32x4_mul(low, wasm_u32x4_const(1 << 28, 1 << 24, 1 << 20, 1 << 16));
    high = wasm_i32x4_mul(high, wasm_u32x4_const(1 << 12, 1 << 8, 1 << 4, 1));
    return {wasm_u32x4_shr(low, 28), wasm_u32x4_shr(high, 28)};
}
inline Floats permute(Floats a, Ints from) {
    return {simd_details::permute(a.low, a.high, from.low),
            simd_details::permute(a.low, a.high, from.high)};
}
inline Ints permute(Ints a, Ints from) {
    return {simd_details::permute(a.low, a.high, from.low),
            simd_details::permute(a.low, a.high, from.high)};
}

#else

struct Floats {
    float v[lanes];
};
struct Ints {
    uint32_t v[lanes];
};

namespace simd_details {
template <typename Result, typename Lane>
Result each_lane(const Lane& lane) {
    Result a;
    for (int k = 0; k < lanes; k++) a.v[k] = lane(k);
    return a;
}
template <typename Test>
uint32_t mask_of(const Test& test) {
    uint32_t mask = 0;
    for (int k = 0; k < lanes; k++) mask |= static_cast<uint32_t>(test(k)) << k;
    return mask;
}
}  // namespace simd_details

inline Floats splat(float a) {
    return simd_details::each_lane<Floats>([&](int) { return a; });
}
inline Floats load(const float* p) {
    return simd_details::each_lane<Floats>([&](int k) { return p[k]; });
}
inline Ints load(const uint32_t* p) {
    return simd_details::each_lane<Ints>([&](int k) { return p[k]; });
}
inline void store(const Floats& a, float* p) { std::copy_n(a.v, lanes, p); }
inline void store(const Ints& a, uint32_t* p) { std::copy_n(a.v, lanes, p); }
inline Floats operator+(const Floats& a, const Floats& b) {
    return simd_details::each_lane<Floats>([&](int k) { return a.v[k] + b.v[k]; });
}
inline Floats operator-(const Floats& a, const Floats& b) {
    return simd_details::each_lane<Floats>([&](int k) { return a.v[k] - b.v[k]; });
}
inline Floats operator*(const Floats& a, const Floats& b) {
    return simd_details::each_lane<Floats>([&](int k) { return a.v[k] * b.v[k]; });
}
inline Floats operator/(const Floats& a, const Floats& b) {
    return simd_details::each_lane<Floats>([&](int k) { return a.v[k] / b.v[k]; });
}
inline Floats multiply_subtract(const Floats& a, const Floats& b, const Floats& c) {
    return a * b - c;
}
inline Floats min(const Floats& a, const Floats& b) {
    return simd_details::each_lane<Floats>(
        [&](int k) { return a.v[k] < b.v[k] ? a.v[k] : b.v[k]; });
}
inline Floats max(const Floats& a, const Floats& b) {
    return simd_details::each_lane<Floats>(
        [&](int k) { return a.v[k] > b.v[k] ? a.v[k] : b.v[k]; });
}
inline Floats abs(const Floats& a) {
    return simd_details::each_lane<Floats>([&](int k) { return std::abs(a.v[k]); });
}
inline Floats max_abs(const Floats& a, const Floats& b) { return max(abs(a), abs(b)); }
inline uint32_t less(const Floats& a, const Floats& b) {
    return simd_details::mask_of([&](int k) { return a.v[k] < b.v[k]; });
}
inline uint32_t less_equal(const Floats& a, const Floats& b) {
    return simd_details::mask_of([&](int k) { return a.v[k] <= b.v[k]; });
}
inline uint32_t equal(const Ints& a, uint32_t b) {
    return simd_details::mask_of([&](int k) { return a.v[k] == b; });
}
inline Ints lanes_of(LaneOrder order) {
    return simd_details::each_lane<Ints>([&](int k) { return order >> 4 * k & 7; });
}
inline Floats permute(const Floats& a, const Ints& from) {
    return simd_details::each_lane<Floats>([&](int k) { return a.v[from.v[k]]; });
}
inline Ints permute(const Ints& a, const Ints& from) {
    return simd_details::each_lane<Ints>([&](int k) { return a.v[from.v[k]]; });
}

#endif

inline Floats compress(const Floats& a, uint32_t mask) {
    return permute(a, lanes_of(simd_details::set_bits[mask]));
}
inline Ints compress(const Ints& a, uint32_t mask) {
    return permute(a, lanes_of(simd_details::set_bits[mask]));
}

#endif

#ifdef __AVX2__
inline Floats operator+(Floats a, Floats b) { return {a.v + b.v}; }
inline Floats operator-(Floats a, Floats b) { return {a.v - b.v}; }
inline Floats operator*(Floats a, Floats b) { return {a.v * b.v}; }
inline Floats operator/(Floats a, Floats b) { return {a.v / b.v}; }
#endif

// Eight floats at once: AVX2 where the compiler may use it, elsewhere plain loops with the same
// results. Each instruction that chapter 05 needs is named here once.
#pragma once
#include <bit>
#include <cstdint>
#include <cstring>

#ifdef __AVX2__
#include <immintrin.h>
#endif

/// Eight floats; their arithmetic is that of single floats, lane by lane, with the same rounding.
struct Float8 {
#ifdef __AVX2__
    __m256 v;
#else
    float v[8];
#endif
};

/// Eight whole numbers.
struct Int8 {
#ifdef __AVX2__
    __m256i v;
#else
    int32_t v[8];
#endif
};

#ifdef __AVX2__

inline Float8 load8(const void* p) { return {_mm256_load_ps(static_cast<const float*>(p))}; }
inline Int8 load8_int(const void* p) { return {_mm256_load_si256(static_cast<const __m256i*>(p))}; }
inline void store8(Float8 a, void* p) { _mm256_storeu_ps(static_cast<float*>(p), a.v); }
inline void store8(Int8 a, void* p) { _mm256_storeu_si256(static_cast<__m256i*>(p), a.v); }
inline Float8 splat8(float a) { return {_mm256_set1_ps(a)}; }
inline Float8 operator+(Float8 a, Float8 b) { return {_mm256_add_ps(a.v, b.v)}; }
inline Float8 operator-(Float8 a, Float8 b) { return {_mm256_sub_ps(a.v, b.v)}; }
inline Float8 operator*(Float8 a, Float8 b) { return {_mm256_mul_ps(a.v, b.v)}; }
inline Float8 operator/(Float8 a, Float8 b) { return {_mm256_div_ps(a.v, b.v)}; }
/// a b - c; one rounding or two.
inline Float8 multiply_subtract(Float8 a, Float8 b, Float8 c) {
#ifdef __FMA__
    return {_mm256_fmsub_ps(a.v, b.v, c.v)};
#else
    return a * b - c;
#endif
}
/// a < b ? a : b, so that b comes back when either is NaN; max8 likewise.
inline Float8 min8(Float8 a, Float8 b) { return {_mm256_min_ps(a.v, b.v)}; }
inline Float8 max8(Float8 a, Float8 b) { return {_mm256_max_ps(a.v, b.v)}; }
/// Bit i is set where lane i of a is less than (or equal to) that of b; NaN: not set.
inline uint32_t less(Float8 a, Float8 b) {
    return static_cast<uint32_t>(_mm256_movemask_ps(_mm256_cmp_ps(a.v, b.v, _CMP_LT_OQ)));
}
inline uint32_t less_equal(Float8 a, Float8 b) {
    return static_cast<uint32_t>(_mm256_movemask_ps(_mm256_cmp_ps(a.v, b.v, _CMP_LE_OQ)));
}
/// The lower four lanes change places with the upper four.
inline Float8 swap_halves(Float8 a) { return {_mm256_permute2f128_ps(a.v, a.v, 1)}; }
/// Rounds towards 0.
inline Int8 to_int(Float8 a) { return {_mm256_cvttps_epi32(a.v)}; }
/// Lane i becomes lane `order` >> 4 i, for i = 0 .. 7.
inline Int8 order_lanes(uint32_t order) {
    const __m256i shifts = _mm256_setr_epi32(0, 4, 8, 12, 16, 20, 24, 28);
    return {_mm256_srlv_epi32(_mm256_set1_epi32(static_cast<int>(order)), shifts)};
}
inline Float8 permute(Float8 a, Int8 lanes) { return {_mm256_permutevar8x32_ps(a.v, lanes.v)}; }
inline Int8 permute(Int8 a, Int8 lanes) { return {_mm256_permutevar8x32_epi32(a.v, lanes.v)}; }

#else

inline Float8 load8(const void* p) {
    Float8 a;
    std::memcpy(a.v, p, sizeof a.v);
    return a;
}
inline Int8 load8_int(const void* p) {
    Int8 a;
    std::memcpy(a.v, p, sizeof a.v);
    return a;
}
inline void store8(Float8 a, void* p) { std::memcpy(p, a.v, sizeof a.v); }
inline void store8(Int8 a, void* p) { std::memcpy(p, a.v, sizeof a.v); }
template <typename F>
Float8 lane_by_lane(const F& f) {
    Float8 a;
    for (int i = 0; i < 8; i++) a.v[i] = f(i);
    return a;
}
inline Float8 splat8(float a) {
    return lane_by_lane([&](int) { return a; });
}
inline Float8 operator+(Float8 a, Float8 b) {
    return lane_by_lane([&](int i) { return a.v[i] + b.v[i]; });
}
inline Float8 operator-(Float8 a, Float8 b) {
    return lane_by_lane([&](int i) { return a.v[i] - b.v[i]; });
}
inline Float8 operator*(Float8 a, Float8 b) {
    return lane_by_lane([&](int i) { return a.v[i] * b.v[i]; });
}
inline Float8 operator/(Float8 a, Float8 b) {
    return lane_by_lane([&](int i) { return a.v[i] / b.v[i]; });
}
inline Float8 multiply_subtract(Float8 a, Float8 b, Float8 c) { return a * b - c; }
inline Float8 min8(Float8 a, Float8 b) {
    return lane_by_lane([&](int i) { return a.v[i] < b.v[i] ? a.v[i] : b.v[i]; });
}
inline Float8 max8(Float8 a, Float8 b) {
    return lane_by_lane([&](int i) { return a.v[i] > b.v[i] ? a.v[i] : b.v[i]; });
}
inline uint32_t less(Float8 a, Float8 b) {
    uint32_t mask = 0;
    for (int i = 0; i < 8; i++) mask |= static_cast<uint32_t>(a.v[i] < b.v[i]) << i;
    return mask;
}
inline uint32_t less_equal(Float8 a, Float8 b) {
    uint32_t mask = 0;
    for (int i = 0; i < 8; i++) mask |= static_cast<uint32_t>(a.v[i] <= b.v[i]) << i;
    return mask;
}
inline Float8 swap_halves(Float8 a) {
    return lane_by_lane([&](int i) { return a.v[i ^ 4]; });
}
inline Int8 to_int(Float8 a) {
    Int8 b;
    for (int i = 0; i < 8; i++) b.v[i] = static_cast<int32_t>(a.v[i]);
    return b;
}
inline Int8 order_lanes(uint32_t order) {
    Int8 lanes;
    for (int i = 0; i < 8; i++) lanes.v[i] = static_cast<int32_t>(order >> (4 * i) & 7);
    return lanes;
}
inline Float8 permute(Float8 a, Int8 lanes) {
    return lane_by_lane([&](int i) { return a.v[lanes.v[i]]; });
}
inline Int8 permute(Int8 a, Int8 lanes) {
    Int8 b;
    for (int i = 0; i < 8; i++) b.v[i] = a.v[lanes.v[i]];
    return b;
}

#endif

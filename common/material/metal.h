// How much light a metal reflects.
#pragma once
#include "common/base/vec.h"

/// The share of unpolarised light that a metal of complex index eta + i k reflects; one channel.
///
///   d = eta^2 - k^2 - sin^2,  a2_b2 = a^2 + b^2 = sqrt(d^2 + 4 eta^2 k^2),  a^2 = (a2_b2 + d) / 2
///   R_s = (a2_b2 - 2 a cos + cos^2) / (a2_b2 + 2 a cos + cos^2)
///   R_p = R_s (cos^2 a2_b2 - 2 a cos sin^2 + sin^4) / (cos^2 a2_b2 + 2 a cos sin^2 + sin^4)
///   R = (R_s + R_p) / 2
///
/// Numerators are sums of squares such as (a - cos)^2 + b^2, but rounding may make them negative.
/// For eta = k = 0 at normal incidence a2_b2 is 0, and R_p would be 0 / 0: R is then 1.
/// source  Born, Wolf, "Principles of Optics", ch. 14
/// tested by  "identity: a metal's reflectance is Fresnel's with a complex index"
inline float fresnel_conductor(float cos_i, float eta, float k) {
    float cos2 = cos_i * cos_i, sin2 = std::max(0.0f, 1 - cos2);
    float d = eta * eta - k * k - sin2;
    float a2_b2 = std::max(std::sqrt(d * d + 4 * eta * eta * k * k), 1e-20f);
    float a = std::sqrt(std::max(0.0f, (a2_b2 + d) / 2));
    float s = 2 * a * cos_i, p = s * sin2;
    float R_s = std::max(0.0f, a2_b2 - s + cos2) / (a2_b2 + s + cos2);
    float R_p =
        R_s * std::max(0.0f, cos2 * a2_b2 - p + sin2 * sin2) / (cos2 * a2_b2 + p + sin2 * sin2);
    return (R_s + R_p) / 2;
}

/// The k of the metal with eta = 1 that reflects so much of light that arrives along the normal.
///
///   k = 2 sqrt(r) / sqrt(1 - r),  r at most 0.9999      source  pbrt-v4
inline Rgb k_of_reflectance(Rgb reflectance) {
    auto k = [](float r) {
        r = std::min(r, 0.9999f);
        return 2 * std::sqrt(r) / std::sqrt(1 - r);
    };
    return {k(reflectance.r), k(reflectance.g), k(reflectance.b)};
}

inline Rgb fresnel_conductor(float cos_i, Rgb eta, Rgb k) {
    return {fresnel_conductor(cos_i, eta.r, k.r), fresnel_conductor(cos_i, eta.g, k.g),
            fresnel_conductor(cos_i, eta.b, k.b)};
}

// taught by chapter 05
// Mirrors and glass: where light goes, and how much of it.
#pragma once
#include <optional>

#include "common/base/vec.h"

/// The mirror direction of wo about n.      wi = 2 (n.wo) n - wo
inline Vec3 reflect(Vec3 wo, Vec3 n) { return 2 * dot(wo, n) * n - wo; }

/// The direction into which light from wo is refracted; eta: index there / index on wo's side.
///
///   sin_t = sin_i / eta  (Snell);  wi = -wo / eta + (cos_i / eta - cos_t) n
///
/// n is on wo's side. Nothing where all light is reflected (sin_t > 1).
inline std::optional<Vec3> refract(Vec3 wo, Vec3 n, float eta) {
    float cos_i = dot(wo, n);
    float sin2_t = std::max(0.0f, 1 - cos_i * cos_i) / (eta * eta);
    if (sin2_t >= 1) return {};
    float cos_t = std::sqrt(1 - sin2_t);
    return normalize((-1 / eta) * wo + (cos_i / eta - cos_t) * n);
}

/// The share of unpolarised light that glass reflects; the rest, 1 - R, goes through.
///
///   r_s = (cos_i - eta cos_t) / (cos_i + eta cos_t)
///   r_p = (eta cos_i - cos_t) / (eta cos_i + cos_t)
///   R = (r_s^2 + r_p^2) / 2
///
/// cos_i in [0,1]; eta: index beyond the surface over index here. 1 under total reflection.
/// source  Fresnel 1823      tested by  "truth: Fresnel's equations for glass", within 1e-6 / cos_t
inline float fresnel_dielectric(float cos_i, float eta) {
    float sin2_t = std::max(0.0f, 1 - cos_i * cos_i) / (eta * eta);
    if (sin2_t >= 1) return 1;
    float cos_t = std::sqrt(1 - sin2_t);
    float r_s = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    float r_p = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    return (r_s * r_s + r_p * r_p) / 2;
}

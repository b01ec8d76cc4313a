// taught by chapter 07
// What sampling a surface returns; uniform directions, mirrors and glass.
#pragma once
#include "common/material/hit.h"
#include "common/material/optics.h"

/// A direction sampled from a BSDF. pdf_w == 0: no sample, the path ends.
///
/// specular: mirror or glass, where light leaves in one direction or two. f and pdf_w are then
/// Dirac deltas; these fields hold the factors before the deltas, which cancel in f cos / pdf_w.
struct BsdfSample {
    Vec3 wi;          // unit
    Rgb f;            // sr^-1, without the cosine
    float pdf_w = 0;  // sr^-1
    bool specular = false;
};

/// A uniformly distributed direction of the hemisphere around +z.
///
///   z = 1 - u1,  phi = 2 pi u2;      pdf_w = 1 / (2 pi)
///
/// u in [0,1)^2; z in (0,1]      tested by  "density: uniform hemisphere", chi^2 at 1e-6
inline Vec3 sample_uniform_hemisphere(Vec2 u) {
    float z = 1 - u.x, r = std::sqrt(std::max(0.0f, 1 - z * z));
    return from_cylindrical(r, u.y, z);
}
inline float pdf_uniform_hemisphere() { return 1 / (2 * pi); }

/// The mirror direction.      f cos = F, the share of light that the metal reflects (Fresnel)
inline BsdfSample sample_mirror(const Hit& x, Vec3 wo) {
    float cos_o = dot(wo, x.n);
    Rgb F = fresnel_conductor(cos_o, x.material->eta, x.material->k);
    return {reflect(wo, x.n), F / cos_o, 1, true};
}

/// Samples reflection or refraction by glass: one of them at random, so the path does not branch.
///
///   P_R = R (Fresnel), P_T = 1 - R;  f cos / P = 1 for reflection, 1 / eta^2 for refraction
///
/// eta: refractive index beyond the surface over the index on wo's side. Radiance over index^2 is
/// conserved, hence 1 / eta^2.      source  Veach 1997, sec. 5.2
inline BsdfSample sample_dielectric(const Hit& x, Vec3 wo, float u) {
    float eta = x.front ? x.material->ior : 1 / x.material->ior;
    float cos_o = dot(wo, x.n), R = fresnel_dielectric(cos_o, eta);
    if (u < R) {
        float f = R / cos_o;
        return {reflect(wo, x.n), {f, f, f}, R, true};
    }
    std::optional<Vec3> wi = refract(wo, x.n, eta);
    if (!wi) return {};
    float f = (1 - R) / (eta * eta) / std::abs(dot(*wi, x.n));
    return {*wi, {f, f, f}, 1 - R, true};
}

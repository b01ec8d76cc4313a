// taught by chapter 10
// The BSDF of diffuse surfaces, mirrors and glass: its value, its samples and their density.
#pragma once
#include "common/material/bsdf.h"
#include "common/material/cosine.h"

namespace basic_bsdf {

/// The BSDF f(x, wo, wi) in sr^-1, without the cosine; 0 for mirrors and glass (Dirac deltas).
///
///   diffuse:  f = reflectance / pi  on wo's side of the surface
inline Rgb eval_bsdf(const Hit& x, Vec3 /*wo*/, Vec3 wi) {
    if (x.material->type != MaterialType::diffuse) return {};
    if (dot(wi, x.n) <= 0 || dot(wi, x.ng) <= 0) return {};
    return x.material->reflectance / pi;
}

/// The density of sample_bsdf for wi, in sr^-1; 0 for mirrors and glass (Dirac deltas).
inline float pdf_bsdf(const Hit& x, Vec3 /*wo*/, Vec3 wi) {
    if (x.material->type != MaterialType::diffuse) return 0;
    if (dot(wi, x.n) <= 0 || dot(wi, x.ng) <= 0) return 0;
    return pdf_cosine_hemisphere(dot(wi, x.n));
}

/// Samples the next direction of the path. u1 chooses reflection or refraction, u2 the direction.
inline BsdfSample sample_bsdf(const Hit& x, Vec3 wo, float u1, Vec2 u2) {
    switch (x.material->type) {
        case MaterialType::diffuse: {
            Vec3 wi = Frame(x.n).to_world(sample_cosine_hemisphere(u2));
            return {wi, eval_bsdf(x, wo, wi), pdf_bsdf(x, wo, wi)};
        }
        case MaterialType::conductor: return sample_mirror(x, wo);
        case MaterialType::dielectric: return sample_dielectric(x, wo, u1);
    }
    return {};
}

}  // namespace basic_bsdf

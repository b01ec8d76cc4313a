// taught by chapter 10
// Cosine-distributed directions; and the BSDF of diffuse surfaces, mirrors and glass.
#pragma once
#include "common/material/bsdf.h"

/// A direction of the hemisphere around +z, with density proportional to its cosine z.
///
///   r = sqrt(u1),  phi = 2 pi u2,  z = sqrt(1 - u1);      pdf_w = cos / pi
///
/// A uniform point of the unit disk, projected up to the sphere. u in [0,1)^2; z in (0,1].
/// source  Malley 1988      tested by  "density: cosine hemisphere", chi^2 at 1e-6
inline Vec3 sample_cosine_hemisphere(Vec2 u) {
    return from_cylindrical(std::sqrt(u.x), u.y, std::sqrt(1 - u.x));
}
inline float pdf_cosine_hemisphere(float cos) { return cos / pi; }

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

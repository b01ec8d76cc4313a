// Chapter 07: path tracing. The rendering equation, solved by random walks from the camera.
//
//   Lo(x, wo) = Le(x, wo) + integral f(x, wo, wi) Li(x, wi) cos(wi) dwi
//             ~ Le(x, wo) + f(x, wo, wi) Li(x, wi) cos(wi) / pdf_w(wi)      one wi, drawn by pdf_w
#pragma once
#include "common/material/hit.h"
#include "common/material/optics.h"
#include "common/path/sampler.h"
#include "common/recording/recorder.h"
#include "common/scene/intersect.h"

namespace ch07 {

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
inline Vec2 invert_uniform_hemisphere(Vec3 w) {
    float phi = std::atan2(w.y, w.x);
    return {1 - w.z, (phi < 0 ? phi + 2 * pi : phi) / (2 * pi)};
}

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
    return pdf_uniform_hemisphere();
}

/// Samples the next direction of the path. u1 chooses reflection or refraction, u2 the direction.
inline BsdfSample sample_bsdf(const Hit& x, Vec3 wo, float u1, Vec2 u2) {
    switch (x.material->type) {
        case MaterialType::diffuse: {
            Vec3 wi = Frame(x.n).to_world(sample_uniform_hemisphere(u2));
            return {wi, eval_bsdf(x, wo, wi), pdf_bsdf(x, wo, wi)};
        }
        case MaterialType::conductor: return sample_mirror(x, wo);
        case MaterialType::dielectric: return sample_dielectric(x, wo, u1);
    }
    return {};
}

/// Estimates Li, the radiance that arrives along the ray, from one path.
///
///   L = sum over the path's vertices x_k of  beta_k Le(x_k),   beta_k = product of f cos / pdf_w
///
/// Unbiased up to scene.max_depth scattering events. The variance is large: a path contributes
/// only if it happens to hit a light.
/// source  Kajiya 1986      tested by  "ch07 path tracing", within 5 standard errors
inline Rgb trace(const Scene& scene, Ray ray, Sampler& sampler, Recorder& recorder) {
    Rgb L, beta = {1, 1, 1};
    for (int depth = 0;; depth++) {
        // Find the next vertex, or the sky.
        std::optional<Hit> x = intersect(scene, ray);
        recorder.vertex(x);

        // Add the light emitted there.
        Rgb Le = x ? emission(scene, *x) : scene.sky;
        L += beta * Le;
        recorder.emitted(Le);
        if (!x) return L;
        if (depth == scene.max_depth) {
            recorder.cut();
            return L;
        }

        // Sample the next direction, and divide by its density.
        Vec3 wo = -ray.d;
        float u1 = sampler.u1();
        BsdfSample s = sample_bsdf(*x, wo, u1, sampler.u2());
        if (s.pdf_w == 0) return L;
        beta *= s.f * (std::abs(dot(s.wi, x->n)) / s.pdf_w);
        if (is_black(beta)) return L;
        recorder.scatter(s, beta);
        ray = spawn_ray(*x, s.wi);
    }
}

}  // namespace ch07

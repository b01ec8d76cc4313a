// Chapter 08: Russian roulette. Terminate paths at random; give the survivors a larger weight.
//
//   E[q (X / q) + (1 - q) 0] = E[X]      for any survival probability q in (0,1]
//   its variance:  Var[X] / q + E[X]^2 (1 - q) / q
#pragma once
#include "common/material/bsdf.h"
#include "common/path/sampler.h"
#include "common/recording/recorder.h"
#include "common/scene/intersect.h"

namespace ch08 {

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

/// The probability q that a path of throughput beta continues.
///
///   q = max(beta), within [0.05, 1];  1 for the first few vertices
///
/// The largest channel of beta: where q is below 1, no channel of beta / q is above 1.
/// At most 1: a path that loses nothing continues up to the depth limit.
/// At least 0.05: so one survival multiplies the weight by at most 20.
inline float survival_probability(Rgb beta, int depth) {
    if (depth < 3) return 1;
    return std::clamp(max_component(beta), 0.05f, 1.0f);
}

/// Estimates Li, the radiance that arrives along the ray, from one path.
///
///   L = sum over the path's vertices x_k of  beta_k Le(x_k),   beta_k = product of f cos / pdf_w
///
/// Unbiased up to scene.max_depth scattering events. The variance is large: a path contributes
/// only if it happens to hit a light.
/// source  Kajiya 1986; roulette: Arvo, Kirk 1990      tested by  "ch08 russian roulette",
///   within 5 standard errors
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

        // Russian roulette: stop with probability 1 - q, else divide by q to compensate.
        float q = survival_probability(beta, depth);
        if (sampler.u1() >= q) return L;
        beta /= q;
        recorder.roulette(q, beta);
        ray = spawn_ray(*x, s.wi);
    }
}

}  // namespace ch08

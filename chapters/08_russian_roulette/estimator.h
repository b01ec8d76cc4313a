// Chapter 08: Russian roulette. End a path by chance, and let the survivors count for all.
//
//   E[q (X / q) + (1 - q) 0] = E[X]      for any survival probability q in (0,1]
//   its variance:  Var[X] / q + E[X]^2 (1 - q) / q
#pragma once
#include "common/material/bsdf.h"
#include "common/path/sampler.h"
#include "common/recording/recorder.h"

namespace ch08 {

/// f(x, wo, wi) in sr^-1, without the cosine; 0 for mirrors and glass, where no wi but one counts.
///
///   diffuse:  f = reflectance / pi  on wo's side of the surface
inline Rgb eval_bsdf(const Hit& x, Vec3 /*wo*/, Vec3 wi) {
    if (x.material->type != MaterialType::diffuse) return {};
    if (dot(wi, x.n) <= 0 || dot(wi, x.ng) <= 0) return {};
    return x.material->reflectance / pi;
}

/// The density, in sr^-1, with which sample_bsdf draws wi; 0 for mirrors and glass.
inline float pdf_bsdf(const Hit& x, Vec3 /*wo*/, Vec3 wi) {
    if (x.material->type != MaterialType::diffuse) return 0;
    if (dot(wi, x.n) <= 0 || dot(wi, x.ng) <= 0) return 0;
    return pdf_uniform_hemisphere();
}

/// Draws the direction in which the path goes on. u1 chooses what happens, u2 the direction.
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

/// The probability with which a path of throughput beta goes on.
///
///   q = max(beta), within [0.05, 0.95];  1 for the first few vertices
///
/// From the largest channel: no channel of beta / q is above 1, or beta / 0.95. Below 1, so that a
/// path that loses nothing (mirrors, total reflection) ends as well; not below 0.05, so that no
/// path ever counts for more than 20.
inline float survival_probability(Rgb beta, int depth) {
    if (depth < 3) return 1;
    return std::clamp(max_component(beta), 0.05f, 0.95f);
}

/// Estimates Li along the ray from one path.
///
///   L = sum over the path's vertices x_k of  beta_k Le(x_k),   beta_k = product of f cos / pdf_w
///
/// Unbiased up to scene.max_depth scattering events. The variance is large: a path brings light
/// only when it happens to hit some.
/// source  Kajiya 1986; roulette: Arvo, Kirk 1990      tested by  "ch08 russian roulette"
inline Rgb trace(const Scene& scene, Ray ray, Sampler& sampler, Recorder& recorder) {
    Rgb L, beta = {1, 1, 1};
    for (int depth = 0;; depth++) {
        // Find the next vertex, or the sky.
        std::optional<Hit> x = intersect(scene, ray);
        recorder.vertex(x);

        // Add what shines there.
        Rgb Le = x ? emission(scene, *x) : scene.sky;
        L += beta * Le;
        recorder.emitted(Le);
        if (!x) return L;
        if (depth == scene.max_depth) {
            recorder.cut();
            return L;
        }

        // Go on in one direction, and count it for all those that were not taken.
        Vec3 wo = -ray.d;
        float u1 = sampler.u1();
        BsdfSample s = sample_bsdf(*x, wo, u1, sampler.u2());
        if (s.pdf_w == 0) return L;
        beta *= s.f * (std::abs(dot(s.wi, x->n)) / s.pdf_w);
        if (is_black(beta)) return L;
        recorder.scatter(s, beta);

        // Play roulette: stop with probability 1 - q, else stand in for those that stopped.
        float q = survival_probability(beta, depth);
        if (sampler.u1() >= q) return L;
        beta /= q;
        recorder.roulette(q, beta);
        ray = spawn_ray(*x, s.wi);
    }
}

}  // namespace ch08

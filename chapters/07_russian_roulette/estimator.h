// Chapter 07: Russian roulette. End a path by chance, and let the survivors count for all.
//
//   E[q (X / q) + (1 - q) 0] = E[X]      for any survival probability q in (0,1]
//   its variance:  Var[X] / q + E[X]^2 (1 - q) / q
#pragma once
#include "common/material/bsdf.h"
#include "common/material/metal.h"
#include "common/material/optics.h"
#include "common/path/path_log.h"
#include "common/path/sampler.h"

namespace ch07 {

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

/// Glass sends the path on by reflection or by refraction: by chance, so that it stays one path.
///
///   P_R = R (Fresnel), P_T = 1 - R;  f cos / P = 1 for reflection, 1 / eta^2 for refraction
///
/// eta: index beyond over index here. Radiance is squeezed by 1 / eta^2 where it enters glass, and
/// gets it back where it leaves.      source  Veach 1997, sec. 5.2
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

/// Draws the direction in which the path goes on. u1 chooses what happens, u2 the direction.
inline BsdfSample sample_bsdf(const Hit& x, Vec3 wo, float u1, Vec2 u2) {
    switch (x.material->type) {
        case MaterialType::diffuse: {
            Vec3 wi = Frame(x.n).to_world(sample_uniform_hemisphere(u2));
            return {wi, eval_bsdf(x, wo, wi), pdf_bsdf(x, wo, wi)};
        }
        case MaterialType::conductor: {
            float cos_o = dot(wo, x.n);
            Rgb F = fresnel_conductor(cos_o, x.material->eta, x.material->k);
            return {reflect(wo, x.n), F / cos_o, 1, true};
        }
        case MaterialType::dielectric: return sample_dielectric(x, wo, u1);
    }
    return {};
}

/// The probability with which a path of throughput beta goes on.
///
///   q = 2.5 max(beta), within [0.05, 0.95];  1 for the first few vertices
///
/// From the largest channel: no channel of beta / q is above 0.4, or beta / 0.95. Below 1, so that
/// a path that loses nothing (mirrors, total reflection) ends as well. 2.5: more adds less noise,
/// less saves more rays; of 1, 1.5, 2, 2.5 and 3 it was the most efficient in the Cornell box.
inline float survival_probability(Rgb beta, int depth) {
    if (depth < 3) return 1;
    return std::clamp(2.5f * max_component(beta), 0.05f, 0.95f);
}

/// Estimates Li along the ray from one path.
///
///   L = sum over the path's vertices x_k of  beta_k Le(x_k),   beta_k = product of f cos / pdf_w
///
/// Unbiased up to scene.max_depth scattering events. The variance is large: a path brings light
/// only when it happens to hit some.
/// source  Kajiya 1986; roulette: Arvo, Kirk 1990      tested by  "ch07 russian roulette"
[[gnu::flatten]] inline Rgb trace(const Scene& scene, Ray ray, Sampler& sampler, PathLog& log) {
    Rgb L, beta = {1, 1, 1};
    for (int depth = 0;; depth++) {
        // Find the next vertex. A path that leaves the scene ends in the sky.
        std::optional<Hit> x = intersect(scene, ray);
        if (!x) return L + log.emitted(beta * scene.sky);
        log.vertex(*x);

        // Add what shines there.
        L += log.emitted(beta * emission(scene, *x));
        if (depth == scene.max_depth) {
            log.cut();
            return L;
        }

        // Go on in one direction, and count it for all those that were not taken.
        Vec3 wo = -ray.d;
        float u1 = sampler.u1();
        BsdfSample s = sample_bsdf(*x, wo, u1, sampler.u2());
        if (s.pdf_w == 0) return L;
        beta *= s.f * (std::abs(dot(s.wi, x->n)) / s.pdf_w);
        if (is_black(beta)) return L;
        log.scatter(s.wi, s.f, s.pdf_w, s.specular, beta);

        // Play roulette: stop with probability 1 - q, else stand in for those that stopped.
        float q = survival_probability(beta, depth);
        if (sampler.u1() >= q) return L;
        beta /= q;
        log.roulette(q, beta);
        ray = spawn_ray(*x, s.wi);
    }
}

}  // namespace ch07

// Chapter 11: resampled importance sampling. Draw M cheap candidates, keep the one that gives most.
//
//   w_i = p_hat(y_i) / p(y_i);   keep y = y_i with probability w_i / weight_sum;
//   Ld = f Le V cos W,   W = weight_sum / (M p_hat(y))
#pragma once
#include "common/bsdf.h"
#include "common/light_table.h"
#include "common/metal.h"
#include "common/optics.h"
#include "common/path_log.h"
#include "common/sampler.h"

namespace ch11 {

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
    return pdf_cosine_hemisphere(dot(wi, x.n));
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
            Vec3 wi = Frame(x.n).to_world(sample_cosine_hemisphere(u2));
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
///   q = the largest channel of beta, within [0.05, 0.95];  1 for the first few vertices
///
/// Taken from the largest channel, no channel's beta / q can grow from vertex to vertex. Below 1,
/// so that a path that loses nothing (mirrors, total reflection) ends as well.
inline float survival_probability(Rgb beta, int depth) {
    if (depth < 4) return 1;
    return std::clamp(max_component(beta), 0.05f, 0.95f);
}

/// M: how many candidates compete for one shadow ray.
inline int M = 8;

/// Gets the scene ready for this chapter's trace().
inline void prepare(Scene& scene) { scene.light_table = build_alias_table(light_pmf(scene, 0.25)); }

/// One candidate, chosen among M by its unshadowed contribution.
struct Reservoir {
    LightSample y;
    Rgb f_Le_cos;          // of y: what it would send to wo if nothing were in between
    float weight_sum = 0;  // of all candidates so far

    /// Takes candidate c in place of y with probability weight / weight_sum.
    ///
    /// u in [0,1) decides, and is made uniform again for the next candidate.
    void offer(const LightSample& c, Rgb contribution, float weight, float& u) {
        if (!(weight > 0)) return;
        weight_sum += weight;
        float share = weight / weight_sum;
        if (u < share) {
            y = c, f_Le_cos = contribution;
            u /= share;
        } else {
            u = (u - share) / (1 - share);
        }
    }
};

/// Estimates what all lights send by way of x to wo, by the best of M candidates.
///
///   p_hat(y) = average of f Le cos over the channels: all that is known without a shadow ray
///
/// Unbiased where p_hat > 0 wherever the light counts.
/// Var = Var_p / M + (1 - 1/M) Var_q: what the shadows leave, Var_q, no M takes away.
/// source  Talbot, Cline, Egbert 2005      tested by  "truth: RIS on four lights, all tuples"
inline Rgb direct_light(const Scene& scene, const Hit& x, Vec3 wo, Sampler& sampler, Rgb beta,
                        PathLog& log) {
    if (x.material->type != MaterialType::diffuse) return {};

    // Let the candidates compete.
    Reservoir kept;
    float u = sampler.u1();
    for (int i = 0; i < M; i++) {
        float u1 = sampler.u1();
        LightSample c = sample_light(scene, x, u1, sampler.u2());
        if (c.pdf_w == 0) continue;
        Rgb f_Le_cos = eval_bsdf(x, wo, c.wi) * c.Le * std::max(0.0f, dot(c.wi, x.n));
        float p_hat = average(f_Le_cos);
        kept.offer(c, f_Le_cos, p_hat / c.pdf_w, u);
    }
    if (kept.weight_sum == 0) return {};

    // Ask for shadow only where the winner is.
    const LightSample& y = kept.y;
    float W = kept.weight_sum / (static_cast<float>(M) * average(kept.f_Le_cos));
    if (occluded(scene, spawn_ray(x, y.wi, y.dist))) return {};
    return log.direct(beta * kept.f_Le_cos * W, y.wi, 1 / W, pdf_bsdf(x, wo, y.wi));
}

/// Estimates Li along the ray from one path.
///
///   L = Le(x_0) + sum over the path's vertices of  beta_k Ld(x_k),   beta_k = product of f cos /
///   pdf_w
///
/// Emission met by chance counts only where nothing was aimed at: after the camera, mirror and
/// glass. Anywhere else it was Ld of the vertex before.
/// Unbiased up to scene.max_depth scattering events.
/// source  Talbot et al. 2005      tested by  "ch11 ris"
inline Rgb trace(const Scene& scene, Ray ray, Sampler& sampler, PathLog& log) {
    Rgb L, beta = {1, 1, 1};
    bool count_emission = true;
    for (int depth = 0;; depth++) {
        // Find the next vertex. A path that leaves the scene ends in the sky.
        std::optional<Hit> x = intersect(scene, ray);
        if (!x) return count_emission ? L + log.emitted(beta * scene.sky) : L;
        log.vertex(*x);

        // Add what shines there, unless the vertex before has aimed at it.
        if (count_emission) L += log.emitted(beta * emission(scene, *x));
        if (depth == scene.max_depth) {
            log.cut();
            return L;
        }

        // Aim at a light.
        Vec3 wo = -ray.d;
        L += direct_light(scene, *x, wo, sampler, beta, log);

        // Go on in one direction, and count it for all those that were not taken.
        float u1 = sampler.u1();
        BsdfSample s = sample_bsdf(*x, wo, u1, sampler.u2());
        count_emission = s.specular;
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

}  // namespace ch11

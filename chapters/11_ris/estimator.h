// Chapter 11: resampled importance sampling. Draw M cheap candidates, keep the one that gives most.
//
//   w_i = p_hat(y_i) / p(y_i);   keep y = y_i with probability w_i / weight_sum;
//   Ld = f Le V cos W,   W = weight_sum / (M p_hat(y))
#pragma once
#include "common/light/light_table.h"
#include "common/material/bsdf.h"
#include "common/material/metal.h"
#include "common/material/optics.h"
#include "common/path/path_log.h"
#include "common/path/roulette.h"
#include "common/path/sampler.h"

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

/// M: how many candidates compete for one shadow ray.
inline int M = 16;

/// Gets the scene ready for this chapter's trace().
inline void prepare(Scene& scene) { scene.light_table = build_alias_table(light_pmf(scene, 0.25)); }

/// p_hat: what light i could send by way of x if nothing were in between, from its centre alone.
///
///   area:  p_hat = L A cos_x cos_y / d^2,  with each cosine as large as any point of the light may
///          have it (it lies within `spread` radians of the centre), and d at least its radius
///
/// 0 only where the light surely gives nothing.      [W m^-2]
inline float potential(const Scene& scene, size_t i, const Hit& x) {
    const Light& light = scene.lights[i];
    float L = average(light.L);
    if (light.type == LightType::infinite) return pi * L;
    if (light.type == LightType::distant) return L * std::max(0.0f, dot(light.p, x.n));
    const LightShape& shape = scene.light_shapes[i];
    bool area = light.type == LightType::area;
    Vec3 to_y = (area ? shape.centre : light.p) - x.p;
    float d2 = std::max(dot(to_y, to_y), 1e-30f), inv_d = 1 / std::sqrt(d2);
    float spread = area ? shape.radius * inv_d : 0, more = spread + spread * spread;
    if (spread > 0.5f) return L * shape.area / std::max(d2, shape.radius * shape.radius);
    float cos_x = std::min(1.0f, dot(to_y, x.n) * inv_d + more);
    if (!(cos_x > 0)) return 0;
    if (!area) return L * cos_x / d2;
    float cos_y = 1;  // of a light that is flat
    if (shape.flat) {
        cos_y = -dot(to_y, shape.first.n) * inv_d;
        cos_y = std::min(1.0f, (light.two_sided ? std::abs(cos_y) : cos_y) + more);
    }
    return cos_y > 0 ? L * shape.area * cos_x * cos_y * inv_d * inv_d : 0;
}

/// The light kept among the candidates so far.
struct Reservoir {
    size_t light = 0;
    float p_hat = 0;       // of that light
    float weight_sum = 0;  // of all candidates

    /// Takes the candidate with probability weight / weight_sum.
    ///
    /// u in [0,1) decides, and is made uniform again for the next candidate.
    void offer(size_t candidate, float p_hat_candidate, float weight, float& u) {
        if (!(weight > 0)) return;
        weight_sum += weight;
        float share = weight / weight_sum;
        bool taken = u < share;
        light = taken ? candidate : light;
        p_hat = taken ? p_hat_candidate : p_hat;
        u = (taken ? u : u - share) / (taken ? share : 1 - share);
    }
    /// W: what the kept light counts for all others, in place of 1 / probability.
    float W(int candidates) const {
        return p_hat > 0 ? weight_sum / (static_cast<float>(candidates) * p_hat) : 0;
    }
};

/// Draws M lights by power, and keeps one in proportion to its potential at x.
inline Reservoir resample_lights(const Scene& scene, const Hit& x, Sampler& sampler) {
    Reservoir kept;
    float u = sampler.u1(), u1 = sampler.u1();
    for (int i = 0; i < M; i++) {
        // One candidate from each of M slices of the table.
        float slice = (static_cast<float>(i) + u1) / static_cast<float>(M);
        size_t light = pick_light(scene, slice);
        float p_hat = potential(scene, light, x);
        kept.offer(light, p_hat, p_hat / pmf_light(scene, light), u);
    }
    return kept;
}

/// Estimates what all lights send by way of x to wo, by the best of M candidates.
///
///   Ld = f Le V cos / pdf_one W      one point on the light that was kept
///
/// Unbiased where p_hat > 0 wherever the light counts.
/// Var = Var_p / M + (1 - 1/M) Var_q: what the shadows leave, Var_q, no M takes away.
/// source  Talbot, Cline, Egbert 2005      tested by  "truth: RIS on four lights, all tuples"
inline Rgb direct_light(const Scene& scene, const Hit& x, Vec3 wo, Sampler& sampler, Rgb beta,
                        PathLog& log) {
    if (x.material->type != MaterialType::diffuse || scene.lights.empty()) return {};
    Reservoir kept = resample_lights(scene, x, sampler);
    LightSample y = sample_one_light(scene, kept.light, x, sampler.u2());
    float W = kept.W(M);
    if (y.pdf_w == 0 || W == 0) return {};
    Rgb Ld = eval_bsdf(x, wo, y.wi) * y.Le * (std::max(0.0f, dot(y.wi, x.n)) / y.pdf_w * W);
    if (is_black(Ld) || occluded(scene, spawn_ray(x, y.wi, y.dist))) return {};
    return log.direct(beta * Ld, y.wi, y.pdf_w / W, pdf_bsdf(x, wo, y.wi));
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
[[gnu::flatten]] inline Rgb trace(const Scene& scene, Ray ray, Sampler& sampler, PathLog& log) {
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

        // Choose a direction, then aim at a light: so the processor works on both rays at once.
        Vec3 wo = -ray.d;
        float u1 = sampler.u1();
        BsdfSample s = sample_bsdf(*x, wo, u1, sampler.u2());
        L += direct_light(scene, *x, wo, sampler, beta, log);

        // Go on in that direction, and count it for all those that were not taken.
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

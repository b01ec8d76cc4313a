// Chapter 14: multiple importance sampling. Look for light both ways, and trust each where it is
// good.
//
//   L = mis_l f Le V cos / pdf_l + mis_b f Le cos / pdf_b,    mis_l + mis_b = 1 for each direction
#pragma once
#include "common/light/light_table.h"
#include "common/light/pdf_one_light.h"
#include "common/material/ggx.h"
#include "common/path/path_log.h"
#include "common/path/roulette.h"
#include "common/path/sampler.h"

namespace ch14 {

using glossy_bsdf::eval_bsdf, glossy_bsdf::pdf_bsdf, glossy_bsdf::sample_bsdf;

/// The weight of a direction that was drawn with density a, and could have been drawn with b.
///
///   balance: a / (a + b);  power: a^2 / (a^2 + b^2)
///
/// By way of b / a, so that no square overflows. a > 0; an infinite a has weight 1.
/// source  Veach, Guibas 1995      tested by  "identity: MIS weights sum to 1"
inline float balance_heuristic(float a, float b) { return 1 / (1 + b / a); }
inline float power_heuristic(float a, float b) { return 1 / (1 + (b / a) * (b / a)); }

/// How the ways share. One-sample: a coin at each vertex takes one of them, which counts twice.
struct Settings {
    float (*heuristic)(float a, float b) = power_heuristic;
    bool one_sample = false;
};

/// The table that lights are chosen from.
inline LightTable prepare(const Scene& scene) { return build_light_table(light_pmf(scene, 0.25)); }

/// Estimates what all lights send by way of x to wo, from one point of one light.
///
///   Ld = mis_l f Le V cos / pdf_l,    pdf_l = pmf pdf_one
///
/// Mirrors and glass: 0, since no light aimed at lies in the one direction that counts.
inline Rgb direct_light(const Scene& scene, const LightTable& lights, const Settings& settings,
                        const Hit& x, Vec3 wo, double u, Vec2 u2, Rgb beta, PathLog& log) {
    if (is_specular(*x.material) || is_black(beta) || scene.lights.empty()) return {};
    size_t light = pick_light(lights, u);
    LightSample y = sample_one_light(scene, light, x, u2);
    if (y.pdf_w == 0) return {};
    float pdf_l = pmf_light(lights, light) * y.pdf_w;
    float pdf_b = y.delta ? 0 : pdf_bsdf(x, wo, y.wi);
    float mis_l = settings.heuristic(pdf_l, pdf_b);
    Rgb Ld = eval_bsdf(x, wo, y.wi) * y.Le * (mis_l * dot(y.wi, x.n) / pdf_l);
    if (is_black(Ld) || occluded(scene, spawn_ray(x, y.wi, y.dist))) return {};
    return log.direct(beta * Ld, y.wi, pdf_l, pdf_b, mis_l);
}

/// The weight of emission that the BSDF's direction wi from x has met: at y, or else in the sky.
inline float mis_emission(const Scene& scene, const LightTable& lights, const Settings& settings,
                          const Hit& x, Vec3 wi, float pdf_b, const std::optional<Hit>& y) {
    size_t light = static_cast<size_t>(y ? y->light : scene.sky_light);
    float pdf_one = y ? pdf_one_light(scene, light, x, *y) : pdf_sky(x, wi);
    float pdf_l = pmf_light(lights, light) * pdf_one;
    return settings.heuristic(pdf_b, pdf_l);
}

/// Estimates Li along the ray from one path.
///
///   L = Le(x_0) + sum over the path's vertices of  beta_k Ld(x_k) + mis_b beta_k+1 Le(x_k+1)
///
/// Unbiased up to scene.max_depth scattering events. Nowhere much worse than the best way.
/// source  Veach, Guibas 1995      tested by  "ch14 mis"
inline Rgb trace(const Scene& scene, const LightTable& lights, const Settings& settings, Ray ray,
                 Sampler& sampler, PathLog& log) {
    Rgb L, beta = {1, 1, 1};
    Hit last;              // the vertex before
    float pdf_b = 0;       // of the direction that was drawn there
    float count_b = 1;     // how often what it meets counts
    bool only_way = true;  // nothing but this path could find what shines next
    for (int depth = 0;; depth++) {
        // Find the next vertex, or the sky.
        std::optional<Hit> x = intersect(scene, ray);
        if (x) log.vertex(*x);

        // Add what shines there, as far as it is this way's share.
        Rgb Le = x ? emission(scene, *x) : scene.sky;
        if (!is_black(Le)) {
            float mis_b = only_way ? 1 : count_b;
            if (!only_way) mis_b *= mis_emission(scene, lights, settings, last, ray.d, pdf_b, x);
            L += log.emitted(beta * Le * mis_b, mis_b);
        }
        if (!x) return L;
        if (depth == scene.max_depth) {
            log.cut();
            return L;
        }

        // Draw the direction to go on in.
        Vec3 wo = -ray.d;
        float u1 = sampler.u1();
        BsdfSample s = sample_bsdf(*x, wo, u1, sampler.u2());

        // Aim at lights.
        float count_l = !settings.one_sample ? 1 : sampler.u1() < 0.5f ? 2 : 0;
        count_b = settings.one_sample ? 2 - count_l : 1;
        double u = join(sampler.u2());
        Vec2 u2 = sampler.u2();
        L += direct_light(scene, lights, settings, *x, wo, u, u2, beta * count_l, log);

        // Go on in that direction, and count it for all those that were not taken.
        last = *x, pdf_b = s.pdf_w, only_way = s.specular;
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

}  // namespace ch14

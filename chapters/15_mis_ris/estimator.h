// Chapter 15: multiple importance sampling of many lights. Chapters 12 and 14 in one.
//
//   three ways find light: any one light, the best of M candidates, and the BSDF; each is weighed
//   by mis_a = a^2 / (any^2 + best^2 + bsdf^2),    a: the way's own density
#pragma once
#include "common/light/fast_resampling.h"
#include "common/light/pdf_one_light.h"
#include "common/material/ggx.h"
#include "common/path/mis.h"
#include "common/path/roulette.h"
#include "common/path/sampler.h"
#include "common/recording/recorder.h"

namespace ch15 {

using glossy_bsdf::eval_bsdf, glossy_bsdf::pdf_bsdf, glossy_bsdf::sample_bsdf;

/// Chapter 14's weight for three ways: a^2 / (a^2 + b^2 + c^2). Those of one direction sum to 1.
/// tested by  "identity: the three weights sum to 1"
inline float mis_weight(float a, float b, float c) {
    return 1 / (1 + (b / a) * (b / a) + (c / a) * (c / a));
}

/// The lights, and M: candidates for one shadow ray, but no more than there are lights.
inline ManyLights prepare(const Scene& scene, int M = 64) {
    return many_lights(scene, build_light_table(light_pmf(scene, 0)), M);
}

/// The densities towards `light` of the ways that aim: at any light, all alike, and at the best.
///
/// min(1, M pmf) is a heuristic: nobody knows how likely a light is to be the best of M candidates.
/// It does not touch the mean: whatever positive numbers stand here, the three weights sum to 1 for
/// each direction. Only the variance depends on how good they are. 0: one light needs no choice.
inline float pdf_any(const ManyLights& lights, float pdf_one) {
    return pdf_one / static_cast<float>(lights.table.size());
}
inline float pdf_best(const ManyLights& lights, size_t light, float pdf_one) {
    if (lights.table.size() == 1) return 0;
    float M = static_cast<float>(lights.M);
    return std::min(1.0f, M * pmf_light(lights.table, light)) * pdf_one;
}

/// Estimates what all lights send by way of x to wo, from one point of any light.
///
///   Ld = mis_l f Le V cos / pdf_l,    pdf_l = pdf_one / N
///
/// Mirrors and glass: 0, since no light aimed at lies in the one direction that counts.
inline Rgb direct_light(const Scene& scene, const ManyLights& lights, const Hit& x, Vec3 wo,
                        LightNumbers u, Recorder& recorder) {
    if (is_specular(*x.material) || scene.lights.empty()) return {};
    size_t N = scene.lights.size();
    size_t light = std::min(static_cast<size_t>(u.light * static_cast<double>(N)), N - 1);
    LightSample y = sample_one_light(scene, light, x, u.point);
    if (y.pdf_w == 0) return {};
    float pdf_l = pdf_any(lights, y.pdf_w);
    float pdf_b = y.delta ? 0 : pdf_bsdf(x, wo, y.wi);
    float mis_l = mis_weight(pdf_l, pdf_best(lights, light, y.pdf_w), pdf_b);
    Rgb Ld = eval_bsdf(x, wo, y.wi) * y.Le * (mis_l * dot(y.wi, x.n) / pdf_l);
    if (is_black(Ld) || occluded(scene, spawn_ray(x, y.wi, y.dist))) return {};
    recorder.direct(Ld, y.wi, pdf_l, pdf_b, mis_l);
    return Ld;
}

/// How much of a light's target rough metal turns to wo, and the BSDF does not find by itself:
/// mis_l f, both towards the light's centre. + 0.05: a heuristic, as its other points may differ.
inline float lobe_share(const Scene& scene, const ManyLights& lights, size_t light, const Hit& x,
                        Vec3 wo) {
    if (scene.lights[light].type != LightType::area) return 1;
    const LightShape& shape = scene.light_shapes[light];
    Vec3 to_y = shape.centre - x.p;
    float d2 = std::max(dot(to_y, to_y), shape.radius * shape.radius);
    Vec3 wi = to_y / std::sqrt(d2);
    float pdf_one = std::min(d2 / shape.area, densest), pdf_b = pdf_bsdf(x, wo, wi);
    float pdf_l = pdf_best(lights, light, pdf_one);
    return power_heuristic(pdf_l, pdf_b) * average(eval_bsdf(x, wo, wi)) + 0.05f;
}

/// Draws M lights by power, and keeps one in proportion to its target at x, with the MIS weight
/// inside: candidates of which the BSDF takes care are not chosen.
inline Kept resample_lights(const Scene& scene, const ManyLights& lights, const Hit& x, Vec3 wo,
                            double u, float u1) {
    Candidates c = draw_candidates(lights, x, u);
    if (is_rough(*x.material)) {
        for (int i = 0; i < c.M; i++) {
            if (c.p_hat[i] == 0) continue;
            float share = lobe_share(scene, lights, static_cast<size_t>(c.light[i]), x, wo);
            c.p_hat[i] *= share, c.weight[i] *= share;
        }
    }
    return keep_one(c, u1);
}

/// The same from one point of the best light.      Ld = mis_l f Le V cos / pdf_one W
/// source  Talbot et al. 2005      tested by  "truth: irradiance of all lights"
inline Rgb best_light(const Scene& scene, const ManyLights& lights, const Hit& x, Vec3 wo,
                      ResamplingNumbers u, Recorder& recorder) {
    if (is_specular(*x.material)) return {};
    Kept best = resample_lights(scene, lights, x, wo, u.candidates, u.choice);
    LightSample y = sample_one_light(scene, best.light, x, u.point);
    if (y.pdf_w == 0 || best.W == 0) return {};
    float pdf_l = pdf_best(lights, best.light, y.pdf_w);
    float pdf_b = y.delta ? 0 : pdf_bsdf(x, wo, y.wi);
    float mis_l = mis_weight(pdf_l, pdf_any(lights, y.pdf_w), pdf_b);
    Rgb Ld = eval_bsdf(x, wo, y.wi) * y.Le * (mis_l * dot(y.wi, x.n) / y.pdf_w * best.W);
    if (is_black(Ld) || occluded(scene, spawn_ray(x, y.wi, y.dist))) return {};
    recorder.direct(Ld, y.wi, pdf_l, pdf_b, mis_l);
    return Ld;
}

/// The weight of emission that the BSDF's direction wi from x has met: at y, or else in the sky.
inline float mis_emission(const Scene& scene, const ManyLights& lights, const Hit& x, Vec3 wi,
                          float pdf_b, const std::optional<Hit>& y) {
    size_t light = static_cast<size_t>(y ? y->light : scene.sky_light);
    float pdf_one = y ? pdf_one_light(scene, light, x, *y) : pdf_sky(x, wi);
    return mis_weight(pdf_b, pdf_any(lights, pdf_one), pdf_best(lights, light, pdf_one));
}

/// Estimates Li along the ray from one path.
///
///   L = Le(x_0) + sum over the path's vertices of  beta_k Ld(x_k) + mis_b beta_k+1 Le(x_k+1)
///
/// Unbiased up to scene.max_depth scattering events. Nowhere much worse than the best way.
/// source  Veach, Guibas 1995      tested by  "ch15 mis ris"
inline Rgb trace(const Scene& scene, const ManyLights& lights, Ray ray, Sampler& sampler,
                 Recorder& recorder) {
    Rgb L, beta = {1, 1, 1};
    Hit last;              // the vertex before
    float pdf_b = 0;       // of the direction that was drawn there
    bool only_way = true;  // nothing but this path could find what shines next
    for (int depth = 0;; depth++) {
        // Find the next vertex, or the sky.
        std::optional<Hit> x = intersect(scene, ray);
        recorder.vertex(x);

        // Add what shines there, as far as it is this way's share.
        Rgb Le = x ? emission(scene, *x) : scene.sky;
        if (!is_black(Le)) {
            float mis_b = only_way ? 1 : mis_emission(scene, lights, last, ray.d, pdf_b, x);
            L += beta * Le * mis_b;
            recorder.emitted(Le, mis_b);
        }
        if (!x) return L;
        if (depth == scene.max_depth) {
            recorder.cut();
            return L;
        }

        // Draw the direction to go on in.
        Vec3 wo = -ray.d;
        float u1 = sampler.u1();
        BsdfSample s = sample_bsdf(*x, wo, u1, sampler.u2());

        // Aim at lights.
        bool choose = scene.lights.size() > 1;
        LightNumbers u = {choose ? to_unit_double(sampler.u2()) : 0, sampler.u2()};
        L += beta * direct_light(scene, lights, *x, wo, u, recorder);
        if (choose) {
            ResamplingNumbers v = {to_unit_double(sampler.u2()), sampler.u1(), sampler.u2()};
            L += beta * best_light(scene, lights, *x, wo, v, recorder);
        }

        // Go on in that direction, and count it for all those that were not taken.
        last = *x, pdf_b = s.pdf_w, only_way = s.specular;
        if (s.pdf_w == 0) return L;
        beta *= s.f * (std::abs(dot(s.wi, x->n)) / s.pdf_w);
        if (is_black(beta)) return L;
        recorder.scatter(s, beta);

        // Play roulette: stop with probability 1 - q, else stand in for those that stopped.
        float q = survival_probability(2.5f * beta, depth);  // 2.5: an exercise of chapter 08
        if (sampler.u1() >= q) return L;
        beta /= q;
        recorder.roulette(q, beta);
        ray = spawn_ray(*x, s.wi);
    }
}

}  // namespace ch15

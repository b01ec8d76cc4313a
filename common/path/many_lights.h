// taught by chapter 15
// Aiming at lights in two ways, each with its MIS weight.
#pragma once
#include "common/light/fast_resampling.h"
#include "common/light/pdf_one_light.h"
#include "common/material/ggx.h"
#include "common/path/mis.h"
#include "common/path/sampler.h"
#include "common/recording/recorder.h"

using glossy_bsdf::eval_bsdf, glossy_bsdf::pdf_bsdf, glossy_bsdf::sample_bsdf;

/// Chapter 14's weight for three ways: a^2 / (a^2 + b^2 + c^2). Those of one direction sum to 1.
/// tested by  "identity: the three weights sum to 1"
inline float mis_weight(float a, float b, float c) {
    return 1 / (1 + (b / a) * (b / a) + (c / a) * (c / a));
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

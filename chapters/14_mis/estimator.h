// Chapter 14: multiple importance sampling. Look for light both ways, and trust each where it is
// good.
//
//   L = mis_l f Le V cos / pdf_l + mis_b f Le cos / pdf_b,    mis_l + mis_b = 1 for each direction
#pragma once
#include "common/light/light_table.h"
#include "common/light/pdf_one_light.h"
#include "common/material/ggx.h"
#include "common/path/roulette.h"
#include "common/path/sampler.h"
#include "common/recording/recorder.h"

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

/// A light seen from x. The sky: all directions are equally likely, since BSDF sampling draws it by
/// the cosine already (chapter 10), and finds too little of one that shines near the horizon alone.
///
/// tested by  "variance: a sky at the horizon: a third of the error of chapter 10"
inline LightSample sample_beside_bsdf(const Scene& scene, size_t light, const Hit& x, Vec2 u) {
    if (scene.lights[light].type != LightType::infinite)
        return sample_one_light(scene, light, x, u);
    Vec3 wi = from_cylindrical(std::sqrt(u.x * (2 - u.x)), u.y, 1 - u.x);
    return {Frame(x.n).to_world(wi), scene.lights[light].L, infinity, 1 / (2 * pi)};
}
/// The density, in sr^-1, with which that draws wi: the light met at y, or else the sky.
inline float pdf_beside_bsdf(const Scene& scene, size_t light, const Hit& x,
                             const std::optional<Hit>& y) {
    return y ? pdf_one_light(scene, light, x, *y) : 1 / (2 * pi);
}

/// The lights that paths aim at, and how aiming and the BSDF share.
struct Lights {
    LightTable table;
    float (*heuristic)(float a, float b);
};
inline Lights prepare(const Scene& scene, float (*heuristic)(float, float) = power_heuristic) {
    return {build_light_table(light_pmf(scene, 0.25)), heuristic};
}

/// Estimates what all lights send by way of x to wo, from one point of one light.
///
///   Ld = mis_l f Le V cos / pdf_l,    pdf_l = pmf pdf_one
///
/// Mirrors and glass: 0, since no light aimed at lies in the one direction that counts.
inline Rgb direct_light(const Scene& scene, const Lights& lights, const Hit& x, Vec3 wo,
                        LightNumbers u, Recorder& recorder) {
    if (is_specular(*x.material) || scene.lights.empty()) return {};
    size_t light = pick_light(lights.table, u.light);
    LightSample y = sample_beside_bsdf(scene, light, x, u.point);
    if (y.pdf_w == 0) return {};
    float pdf_l = pmf_light(lights.table, light) * y.pdf_w;
    float pdf_b = y.delta ? 0 : pdf_bsdf(x, wo, y.wi);
    float mis_l = lights.heuristic(pdf_l, pdf_b);
    Rgb Ld = eval_bsdf(x, wo, y.wi) * y.Le * (mis_l * dot(y.wi, x.n) / pdf_l);
    if (is_black(Ld) || occluded(scene, spawn_ray(x, y.wi, y.dist))) return {};
    recorder.direct(Ld, y.wi, pdf_l, pdf_b, mis_l);
    return Ld;
}

/// The weight of emission that the BSDF's direction from x has met: at y, or else in the sky.
inline float mis_emission(const Scene& scene, const Lights& lights, const Hit& x, float pdf_b,
                          const std::optional<Hit>& y) {
    size_t light = static_cast<size_t>(y ? y->light : scene.sky_light);
    float pdf_l = pmf_light(lights.table, light) * pdf_beside_bsdf(scene, light, x, y);
    return lights.heuristic(pdf_b, pdf_l);
}

/// Estimates Li along the ray from one path.
///
///   L = Le(x_0) + sum over the path's vertices of  beta_k Ld(x_k) + mis_b beta_k+1 Le(x_k+1)
///
/// Unbiased up to scene.max_depth scattering events. Nowhere much worse than the best way.
/// source  Veach, Guibas 1995      tested by  "ch14 mis"
inline Rgb trace(const Scene& scene, const Lights& lights, Ray ray, Sampler& sampler,
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
            float mis_b = only_way ? 1 : mis_emission(scene, lights, last, pdf_b, x);
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
        LightNumbers u = {to_unit_double(sampler.u2()), sampler.u2()};
        L += beta * direct_light(scene, lights, *x, wo, u, recorder);

        // Go on in that direction, and count it for all those that were not taken.
        last = *x, pdf_b = s.pdf_w, only_way = s.specular;
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

}  // namespace ch14

// Chapter 14: multiple importance sampling (MIS). Sample both lights and BSDF, and weight each
// sample by how well its strategy handles its direction.
//
//   L = mis_l f Le V cos / pdf_l + mis_b f Le cos / pdf_b,    mis_l + mis_b = 1 for each direction
#pragma once
#include "common/light/light_shapes.h"
#include "common/light/light_table.h"
#include "common/material/ggx.h"
#include "common/path/roulette.h"
#include "common/path/sampler.h"
#include "common/recording/recorder.h"
#include "common/scene/intersect.h"

namespace ch14 {

using glossy_bsdf::eval_bsdf, glossy_bsdf::pdf_bsdf, glossy_bsdf::sample_bsdf;

/// The MIS weight of a direction that was sampled with density a; b: the other strategy's density.
///
///   balance: a / (a + b);  power: a^2 / (a^2 + b^2)
///
/// Computed from b / a, so that no square overflows. a > 0; no density is above 1e36 (densest).
/// source  Veach, Guibas 1995      tested by  "identity: MIS weights sum to 1", to 1e-6
inline float balance_heuristic(float a, float b) { return 1 / (1 + b / a); }
inline float power_heuristic(float a, float b) { return 1 / (1 + (b / a) * (b / a)); }

/// Samples a light from x. The sky: uniformly, since BSDF sampling already samples it by the cosine
/// (chapter 10), which finds too little of a sky that is bright only near the horizon.
///
/// tested by  "variance: a sky at the horizon: ...", relMSE below 2/3 of chapter 10's
inline LightSample sample_light_for_mis(const Scene& scene, size_t light, const Hit& x, Vec2 u) {
    if (scene.lights[light].type != LightType::infinite)
        return sample_one_light(scene, light, x, u);
    Vec3 wi = from_cylindrical(std::sqrt(u.x * (2 - u.x)), u.y, 1 - u.x);
    return {Frame(x.n).to_world(wi), scene.lights[light].L, infinity, 1 / (2 * pi)};
}
/// The density of sample_light_for_mis for wi, in sr^-1, of the light hit at y, or else of the sky.
inline float pdf_light_for_mis(const Scene& scene, size_t light, const Hit& x,
                               const std::optional<Hit>& y) {
    return y ? pdf_one_light(scene, light, x, *y) : 1 / (2 * pi);
}

/// The table of lights, and the heuristic that weights light samples and BSDF samples.
struct Lights {
    LightTable table;
    float (*heuristic)(float a, float b);
};
inline Lights prepare(const Scene& scene, float (*heuristic)(float, float) = power_heuristic) {
    return {build_light_table(light_pmf(scene, 0.25)), heuristic};
}

/// Estimates the direct light that x scatters to wo, from one point of one light.
///
///   Ld = mis_l f Le V cos / pdf_l,    pdf_l = pmf pdf_w
///
/// Mirrors and glass: 0, since their f is 0 for every direction that light sampling finds.
inline Rgb direct_light(const Scene& scene, const Lights& lights, const Hit& x, Vec3 wo,
                        LightNumbers u, Recorder& recorder) {
    if (is_specular(*x.material) || scene.lights.empty()) return {};
    size_t light = pick_light(lights.table, u.light);
    LightSample y = sample_light_for_mis(scene, light, x, u.point);
    if (y.pdf_w == 0) return {};
    float pdf_l = pmf_light(lights.table, light) * y.pdf_w;
    float pdf_b = y.delta ? 0 : pdf_bsdf(x, wo, y.wi);
    float mis_l = lights.heuristic(pdf_l, pdf_b);
    Rgb Ld = eval_bsdf(x, wo, y.wi) * y.Le * (mis_l * dot(y.wi, x.n) / pdf_l);
    if (is_black(Ld) || occluded(scene, spawn_ray(x, y.wi, y.dist))) return {};
    recorder.direct(Ld, y.wi, pdf_l, pdf_b, mis_l);
    return Ld;
}

/// The MIS weight of emission that a BSDF sample from x has hit: at y, or else in the sky.
inline float mis_emission(const Scene& scene, const Lights& lights, const Hit& x, float pdf_b,
                          const std::optional<Hit>& y) {
    size_t light = static_cast<size_t>(y ? y->light : scene.sky_light);
    float pdf_l = pmf_light(lights.table, light) * pdf_light_for_mis(scene, light, x, y);
    return lights.heuristic(pdf_b, pdf_l);
}

/// Estimates Li, the radiance that arrives along the ray, from one path.
///
///   L = Le(x_0) + sum over the path's vertices of  beta_k Ld(x_k) + mis_b beta_k+1 Le(x_k+1)
///
/// Unbiased up to scene.max_depth scattering events.
/// Direct light at a vertex: Var <= mean^2 / 2 + Var of any strategy that finds all of it.
/// source  Veach, Guibas 1995      tested by  "ch14 mis", within 5 standard errors
inline Rgb trace(const Scene& scene, const Lights& lights, Ray ray, Sampler& sampler,
                 Recorder& recorder) {
    Rgb L, beta = {1, 1, 1};
    Hit last;                     // the previous vertex
    float pdf_b = 0;              // of the direction that was sampled there
    bool specular_bounce = true;  // light sampling cannot find the light hit next
    for (int depth = 0;; depth++) {
        // Find the next vertex, or the sky.
        std::optional<Hit> x = intersect(scene, ray);
        recorder.vertex(x);

        // Add the light emitted there, times its MIS weight.
        Rgb Le = x ? emission(scene, *x) : scene.sky;
        if (!is_black(Le)) {
            float mis_b = specular_bounce ? 1 : mis_emission(scene, lights, last, pdf_b, x);
            L += beta * Le * mis_b;
            recorder.emitted(Le, mis_b);
        }
        if (!x) return L;
        if (depth == scene.max_depth) {
            recorder.cut();
            return L;
        }

        // Sample the next direction.
        Vec3 wo = -ray.d;
        float u1 = sampler.u1();
        BsdfSample s = sample_bsdf(*x, wo, u1, sampler.u2());

        // Sample lights.
        LightNumbers u = {to_unit_double(sampler.u2()), sampler.u2()};
        L += beta * direct_light(scene, lights, *x, wo, u, recorder);

        // Continue in that direction, and divide by its density.
        last = *x, pdf_b = s.pdf_w, specular_bounce = s.specular;
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

}  // namespace ch14

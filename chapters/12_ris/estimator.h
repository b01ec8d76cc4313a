// Chapter 12: resampled importance sampling (RIS). Draw M cheap candidates, and keep one of them
// with a probability proportional to its weight.
//
//   w_i = p_hat(y_i) / p(y_i);   keep y = y_i with probability w_i / weight_sum;
//   Ld = W f Le V cos / pdf_w,   W = weight_sum / (M p_hat(y))
#pragma once
#include "common/light/light_table.h"
#include "common/material/basic_bsdf.h"
#include "common/path/roulette.h"
#include "common/path/sampler.h"
#include "common/recording/recorder.h"
#include "common/scene/intersect.h"

namespace ch12 {

using basic_bsdf::eval_bsdf, basic_bsdf::pdf_bsdf, basic_bsdf::sample_bsdf;

/// What the target function needs to know about a light: the same fields for every type.
struct LightBounds {
    Vec3 centre;          // m; unit, towards a distant light
    float has_place = 1;  // 0: distant and infinite lights
    Vec3 n;               // normal of a flat light, unit; else 0
    float back = 1;       // -1: a flat light that emits on both sides
    float radius = 0;     // m, of its bounding sphere; 1: the sky, which surrounds x
    float least_cos = 1;  // least cosine at the light; 0: a flat light
    float power = 0;      // area: L A;  point and distant: L;  sky: pi L
};
inline LightBounds light_bounds(const Scene& scene, size_t i) {
    const Light& light = scene.lights[i];
    const LightShape& y = scene.light_shapes[i];
    float L = average(light.L), back = light.two_sided ? -1 : 1;
    if (light.type == LightType::point) return {light.p, 1, {}, 1, 0, 1, L};
    if (light.type == LightType::distant) return {light.p, 0, {}, 1, 0, 1, L};
    if (light.type == LightType::infinite) return {{0, 0, 1}, 0, {}, 1, 1, 1, pi * L};
    if (!y.flat) return {y.centre, 1, {}, 1, y.radius, 1, L * y.area};
    return {y.centre, 1, y.first.n, back, y.radius, 0, L * y.area};
}

/// The target p_hat: the light that x would receive from the light's centre without shadows.
///
///   p_hat = power cos_x cos_y / d^2;   cos_y = 1 and d = 1 for lights without them
///
/// Other points of an area light may be nearer than its centre, or seen less edge-on. So cosines
/// are at least radius / d, and d is at least radius. Where the whole light is behind x or faces
/// away, p_hat is 0. So it is 0 only where the light contributes nothing, and never far too small.
inline float target(const LightBounds& y, const Hit& x) {
    Vec3 to_y = y.centre - y.has_place * x.p;
    float d2 = std::max(dot(to_y, to_y), std::max(y.radius * y.radius, 1e-30f));
    float inv_d = 1 / std::sqrt(d2), least = y.radius * inv_d, least_cos = y.least_cos;
    float cos_x = dot(to_y, x.n) * inv_d, cos_y = -dot(to_y, y.n) * inv_d;
    cos_y = std::max(cos_y, y.back * cos_y);
    float seen = ((cos_x < -1.00001f * least) | (cos_y < -least)) ? 0.0f : 1.0f;
    cos_x = std::max(cos_x, least), cos_y = std::max(cos_y, std::max(least, least_cos));
    return seen * y.power * cos_x * cos_y / d2;
}

/// The candidate kept so far, and the sum of all weights.
struct Reservoir {
    size_t light = 0;
    float p_hat = 0;       // of that light
    float weight_sum = 0;  // of all candidates

    /// Keeps this candidate instead with probability weight / weight_sum.
    ///
    /// u in [0,1) decides, and is then rescaled to [0,1) for the next candidate.
    void offer(size_t candidate, float p_hat_candidate, float weight, float& u) {
        if (!(weight > 0)) return;
        weight_sum += weight;
        float share = weight / weight_sum;
        if (u < share) {
            light = candidate, p_hat = p_hat_candidate;
            u = u / share;
        } else {
            u = (u - share) / (1 - share);
        }
    }
    /// The weight W of the kept light, which replaces 1 / probability.
    float W(int M) const { return p_hat > 0 ? weight_sum / (static_cast<float>(M) * p_hat) : 0; }
};

/// The source of candidates: a table of lights by power, and the number M of candidates.
struct Proposal {
    LightTable lights;
    int M;
};

/// Draws M lights by power, and keeps one with probability proportional to w = p_hat / p at x.
///
/// u: draws all candidates, one from each of M slices of the table; u1: chooses among them.
inline Reservoir resample_lights(const Scene& scene, const Proposal& p, const Hit& x, double u,
                                 float u1) {
    Reservoir kept;
    for (int i = 0; i < p.M; i++) {
        size_t light = pick_light(p.lights, (i + u) / p.M);
        float p_hat = target(light_bounds(scene, light), x);
        kept.offer(light, p_hat, p_hat / pmf_light(p.lights, light), u1);
    }
    return kept;
}

inline Proposal prepare(const Scene& scene, int M) {
    return {build_light_table(light_pmf(scene, 0.25)), M};
}

/// Estimates the direct light that x scatters to wo, from one of M candidate lights.
///
///   Ld = W f Le V cos / pdf_w      one point on the light that was kept
///
/// Unbiased if p_hat > 0 wherever the light contributes.
/// Var = Var_p / M + (1 - 1/M) Var_q for independent candidates: Var_q, by shadows, remains.
/// source  Talbot et al. 2005      tested by  "truth: RIS on four lights, all tuples", to 1e-5
inline Rgb direct_light(const Scene& scene, const Proposal& p, const Hit& x, Vec3 wo,
                        ResamplingNumbers u, Recorder& recorder) {
    if (x.material->type != MaterialType::diffuse || p.lights.empty()) return {};
    Reservoir kept = resample_lights(scene, p, x, u.candidates, u.choice);
    LightSample y = sample_one_light(scene, kept.light, x, u.point);
    float W = kept.W(p.M);
    if (y.pdf_w == 0 || W == 0) return {};
    Rgb Ld = eval_bsdf(x, wo, y.wi) * y.Le * (dot(y.wi, x.n) / y.pdf_w * W);
    if (is_black(Ld) || occluded(scene, spawn_ray(x, y.wi, y.dist))) return {};
    recorder.direct(Ld, y.wi, y.pdf_w / W, pdf_bsdf(x, wo, y.wi));
    return Ld;
}

/// Estimates Li, the radiance that arrives along the ray, from one path.
///
///   L = Le(x_0) + sum over k of  beta_k Ld(x_k) (+ beta_k Le(x_k) behind a mirror or glass)
///
/// Emission that the path hits counts only directly from the camera and after mirrors and glass.
/// Elsewhere it is already part of Ld at the vertex before.
/// Unbiased up to scene.max_depth scattering events.
/// source  Talbot et al. 2005      tested by  "ch12 ris", within 5 standard errors
inline Rgb trace(const Scene& scene, const Proposal& p, Ray ray, Sampler& sampler,
                 Recorder& recorder) {
    Rgb L, beta = {1, 1, 1};
    bool count_emission = true;
    for (int depth = 0;; depth++) {
        // Find the next vertex, or the sky.
        std::optional<Hit> x = intersect(scene, ray);
        recorder.vertex(x);

        // Add the light emitted there, unless the vertex before has sampled it.
        Rgb Le = !count_emission ? Rgb{} : x ? emission(scene, *x) : scene.sky;
        L += beta * Le;
        recorder.emitted(Le);
        if (!x) return L;
        if (depth == scene.max_depth) {
            recorder.cut();
            return L;
        }

        // Sample one of M candidate lights.
        Vec3 wo = -ray.d;
        ResamplingNumbers u = {to_unit_double(sampler.u2()), sampler.u1(), sampler.u2()};
        L += beta * direct_light(scene, p, *x, wo, u, recorder);

        // Sample the next direction, and divide by its density.
        float u1 = sampler.u1();
        BsdfSample s = sample_bsdf(*x, wo, u1, sampler.u2());
        count_emission = s.specular;
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

}  // namespace ch12

// Chapter 12: resampled importance sampling. Draw M cheap candidates and keep one by chance: the
// more it gives, the likelier.
//
//   w_i = p_hat(y_i) / p(y_i);   keep y = y_i with probability w_i / weight_sum;
//   Ld = f Le V cos W,   W = weight_sum / (M p_hat(y))
#pragma once
#include "common/light/light_table.h"
#include "common/material/basic_bsdf.h"
#include "common/path/roulette.h"
#include "common/path/sampler.h"
#include "common/recording/recorder.h"

namespace ch12 {

using basic_bsdf::eval_bsdf, basic_bsdf::pdf_bsdf, basic_bsdf::sample_bsdf;

/// A light as its target needs it: the same numbers for lights of every type.
struct LightBounds {
    Vec3 centre;          // m; unit, towards a light without a place
    float has_place = 1;  // 0: distant and infinite lights
    Vec3 n;               // unit, of a flat light; else 0
    float back = 1;       // -1: a flat light that shines to both sides
    float radius = 0;     // m, of a sphere around it; 1: the sky, which is around x
    float least_cos = 1;  // of the angle at the light; 0: a flat light
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

/// p_hat: what a light could send by way of x if nothing were in between, from its centre alone.
///
///   p_hat = power cos_x cos_y / d^2;   cos_y = 1 and d = 1 for lights that have none
///
/// Other points of an area light may be nearer or seen less edge-on than its centre: its cosines
/// count as radius / d at least, and d as its radius, unless all of it lies behind the surface or
/// turns its back. So p_hat is 0 only where the light gives nothing, and no point gives much more.
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
        if (u < share) {
            light = candidate, p_hat = p_hat_candidate;
            u = u / share;
        } else {
            u = (u - share) / (1 - share);
        }
    }
    /// W: what the kept light counts for all others, in place of 1 / probability.
    float W(int M) const { return p_hat > 0 ? weight_sum / (static_cast<float>(M) * p_hat) : 0; }
};

/// Where candidates come from: a table of the lights by power, and how many for one sample.
struct Proposal {
    LightTable lights;
    int M;
};

/// Draws M lights by power, and keeps one in proportion to its target at x.
///
/// u: one number for the candidates, one from each of M slices of the table; u1 for the choice.
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

/// Estimates what all lights send by way of x to wo, by one of M candidates.
///
///   Ld = f Le V cos / pdf_one W      one point on the light that was kept
///
/// Unbiased where p_hat > 0 wherever the light counts.
/// Var = Var_p / M + (1 - 1/M) Var_q: what the shadows leave, Var_q, no M takes away.
/// source  Talbot, Cline, Egbert 2005      tested by  "truth: RIS on four lights, all tuples"
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

/// Estimates Li along the ray from one path.
///
///   L = Le(x_0) + sum over vertices of  beta_k Ld(x_k),   beta_k = product of f cos / pdf_w
///
/// Emission met by chance counts only where nothing was aimed at: after the camera, mirror and
/// glass. Anywhere else it was Ld of the vertex before.
/// Unbiased up to scene.max_depth scattering events.
/// source  Talbot et al. 2005      tested by  "ch12 ris"
inline Rgb trace(const Scene& scene, const Proposal& p, Ray ray, Sampler& sampler,
                 Recorder& recorder) {
    Rgb L, beta = {1, 1, 1};
    bool count_emission = true;
    for (int depth = 0;; depth++) {
        // Find the next vertex, or the sky.
        std::optional<Hit> x = intersect(scene, ray);
        recorder.vertex(x);

        // Add what shines there, unless the vertex before has aimed at it.
        Rgb Le = !count_emission ? Rgb{} : x ? emission(scene, *x) : scene.sky;
        L += beta * Le;
        recorder.emitted(Le);
        if (!x) return L;
        if (depth == scene.max_depth) {
            recorder.cut();
            return L;
        }

        // Aim at one of M lights.
        Vec3 wo = -ray.d;
        ResamplingNumbers u = {to_unit_double(sampler.u2()), sampler.u1(), sampler.u2()};
        L += beta * direct_light(scene, p, *x, wo, u, recorder);

        // Go on in one direction, and count it for all those that were not taken.
        float u1 = sampler.u1();
        BsdfSample s = sample_bsdf(*x, wo, u1, sampler.u2());
        count_emission = s.specular;
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

}  // namespace ch12

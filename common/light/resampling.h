// taught by chapter 12
// Choosing one of M candidate lights by what each could give.
#pragma once
#include "common/light/light_table.h"

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

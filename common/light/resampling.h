// taught by chapter 12
// Choosing one of M candidate lights by what each could give.
#pragma once
#include "common/light/light_table.h"

/// p_hat: what light i could send by way of x if nothing were in between, from its centre alone.
///
///   area:  p_hat = L A cos_x cos_y / d^2;  point:  L cos_x / d^2;  distant:  L cos_x;  sky:  pi L
///
/// Other points of an area light may be nearer or seen less edge-on than its centre: its cosines
/// count as radius / d at least, and d as its radius, unless all of it lies behind the surface or
/// turns its back. So p_hat is 0 only where the light gives nothing, and no point gives much more.
inline float target(const Scene& scene, size_t i, const Hit& x) {
    const Light& light = scene.lights[i];
    const LightShape& shape = scene.light_shapes[i];
    float L = average(light.L);
    if (light.type == LightType::infinite) return pi * L;
    if (light.type == LightType::distant) return L * std::max(0.0f, dot(light.p, x.n));
    Vec3 to_y = (light.type == LightType::area ? shape.centre : light.p) - x.p;
    float d = std::max({length(to_y), shape.radius, 1e-15f});  // not 0, even in a point light
    float cos_x = dot(to_y, x.n) / d, cos_y = 1, least = shape.radius / d;
    if (light.type == LightType::point) return L * std::max(0.0f, cos_x) / (d * d);
    if (shape.flat) cos_y = -dot(to_y, shape.first.n) / d;
    if (light.two_sided) cos_y = std::abs(cos_y);
    if (cos_x < -least || cos_y < -least) return 0;
    return L * shape.area * std::max(least, cos_x) * std::max(least, cos_y) / (d * d);
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

/// Where candidates come from: the table that they are drawn from, and how many for one sample.
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
        float p_hat = target(scene, light, x);
        kept.offer(light, p_hat, p_hat / pmf_light(p.lights, light), u1);
    }
    return kept;
}

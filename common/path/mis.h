// taught by chapters 12 and 14
// Resampling (RIS): choosing one of M candidate lights by its target; and MIS weights of directions
// that two strategies can sample.
#pragma once
#include "common/light/light_table.h"

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

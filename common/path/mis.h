// taught by chapter 14
// MIS weights of directions that two strategies can sample.
#pragma once
#include "common/light/lights.h"

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

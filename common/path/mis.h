// taught by chapter 14
// How two ways of drawing the same direction share it.
#pragma once
#include "common/light/lights.h"
#include "common/light/pdf_one_light.h"

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

// taught by chapter 10
// Sampling one light.
#pragma once
#include "common/light/light_shapes.h"
#include "common/material/basic_bsdf.h"

/// A sampled point or direction of a light, seen from x. pdf_w == 0: no sample, no contribution.
struct LightSample {
    Vec3 wi;             // unit, from x to the light
    Rgb Le;              // W m^-2 sr^-1, of point and distant lights W m^-2; without f, cos, V
    float dist = 0;      // m: length of the shadow ray, which ends just before the light
    float pdf_w = 0;     // sr^-1; for a point or distant light the probability of choosing it
    bool delta = false;  // a point or distant light: no path can hit it
};

/// Samples a point y of an area light; pdf_w is the density of its direction seen from x.
///
/// zero    if y faces away, is edge-on, or is x itself (cos_y is then not a number)
/// error   unbiased; Var <= about 2 mean^2, however near, for one shape that is all in front of x
/// source  Shirley et al. 1996      tested by  "variance: near-light", within 5 standard errors
inline LightSample sample_area_light(const Scene& scene, size_t light, const Hit& x, Vec2 u) {
    LightPoint y = sample_solid_angle(scene, light, x.p, u);
    Vec3 to_y = y.p - x.p;
    float d = length(to_y);
    Vec3 wi = to_y / d;
    float cos_y = -dot(wi, y.n);
    if (scene.lights[light].two_sided) cos_y = std::abs(cos_y);
    if (!(cos_y > 0)) return {};
    return {wi, scene.lights[light].L, d - (x.eps + y.eps) / cos_y, y.pdf};
}

/// One light: its point or direction as seen from x. The sky is drawn from the hemisphere around n.
inline LightSample sample_one_light(const Scene& scene, size_t i, const Hit& x, Vec2 u) {
    const Light& light = scene.lights[i];
    switch (light.type) {
        case LightType::area: return sample_area_light(scene, i, x, u);
        case LightType::point: {
            Vec3 to_y = light.p - x.p;
            float d2 = dot(to_y, to_y);
            if (d2 == 0) return {};
            return {to_y / std::sqrt(d2), light.L / d2, std::sqrt(d2), 1, true};
        }
        case LightType::distant: return {light.p, light.L, infinity, 1, true};
        case LightType::infinite: {
            Vec3 wi = sample_cosine_hemisphere(u);
            float pdf_w = pdf_cosine_hemisphere(wi.z);
            return {Frame(x.n).to_world(wi), light.L, infinity, pdf_w};
        }
    }
    return {};
}

// The densities of lights.h, for directions that were sampled in another way.
#pragma once
#include "common/light/lights.h"

/// The density of sample_one_light, in sr^-1, for the direction in which a ray from x hit point y
/// of the light.
inline float pdf_one_light(const Scene& scene, size_t light, const Hit& x, const Hit& y) {
    return pdf_solid_angle(scene, light, x.p, y);
}
/// The density of sample_one_light, in sr^-1, for direction wi, in which a ray from x hit the sky.
inline float pdf_sky(const Hit& x, Vec3 wi) {
    return pdf_cosine_hemisphere(std::max(0.0f, dot(wi, x.n)));
}

// The densities of lights.h, asked of a direction that someone else has drawn.
#pragma once
#include "common/light/lights.h"

/// The density, in sr^-1, with which sample_one_light would have drawn the direction from x in
/// which a ray met y, a point of the light.
inline float pdf_one_light(const Scene& scene, size_t light, const Hit& x, const Hit& y) {
    return pdf_solid_angle(scene, light, x.p, y);
}
/// The density of the direction wi from x in which a ray met nothing, and saw the sky.
inline float pdf_sky(const Hit& x, Vec3 wi) {
    return pdf_cosine_hemisphere(std::max(0.0f, dot(wi, x.n)));
}

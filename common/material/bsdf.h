// What sampling a surface returns, and the warp it starts from (chapter 06).
#pragma once
#include "common/base/vec.h"

/// A direction drawn from a BSDF. pdf_w == 0: no sample, the path ends.
///
/// specular: wi is the only direction there is; f and pdf_w then stand for the factors of one
/// delta function, which cancels in f cos / pdf_w.
struct BsdfSample {
    Vec3 wi;          // unit
    Rgb f;            // sr^-1, without the cosine
    float pdf_w = 0;  // sr^-1
    bool specular = false;
};

/// A direction of the hemisphere around +z, all equally likely.
///
///   z = 1 - u1,  phi = 2 pi u2;      pdf_w = 1 / (2 pi)
///
/// u in [0,1)^2; z in (0,1]      tested by  "density: uniform hemisphere"
inline Vec3 sample_uniform_hemisphere(Vec2 u) {
    float z = 1 - u.x, r = std::sqrt(std::max(0.0f, 1 - z * z));
    return from_cylindrical(r, u.y, z);
}
inline float pdf_uniform_hemisphere() { return 1 / (2 * pi); }
inline Vec2 invert_uniform_hemisphere(Vec3 w) {
    float phi = std::atan2(w.y, w.x);
    return {1 - w.z, (phi < 0 ? phi + 2 * pi : phi) / (2 * pi)};
}

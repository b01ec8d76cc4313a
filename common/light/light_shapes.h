// Points on the surface of a light, sampled by area or by the solid angle seen from x.
#pragma once
#include "common/scene/intersect.h"

/// A point of a light.
struct LightPoint {
    Vec3 p, n;      // m; n: unit, on the side that emits
    float eps = 0;  // m: largest distance of p from the surface, by rounding
    float pdf = 0;  // m^-2 by area, sr^-1 by solid angle; 0: no point
};

/// The largest density, in sr^-1: solid angles below 1e-36 sr count as 1e-36 sr.
inline constexpr float densest = 1e36f;

/// Turns a density per area into one per solid angle at x:  pdf_w = pdf_A d^2 / cos_y; 0 if
/// edge-on.
inline float area_to_solid_angle(float pdf_A, Vec3 x, Vec3 y, Vec3 n_y) {
    Vec3 to_y = y - x;
    float d2 = dot(to_y, to_y), d_cos = std::abs(dot(to_y, n_y));
    return d_cos > 0 ? std::min(pdf_A * d2 * (std::sqrt(d2) / d_cos), densest) : 0;
}

namespace light_shape_details {

inline bool is_near(const LightShape& shape, Vec3 x) {
    return length_squared(x - shape.centre) < 4 * shape.radius * shape.radius;
}
/// Samples any light except a parallelogram, by area.
LightPoint sample_pieces(const Scene& scene, size_t light, Vec2 u);
/// Samples a sphere, or any light that is near x, by solid angle.
LightPoint sample_near(const Scene& scene, size_t light, Vec3 x, Vec2 u);

}  // namespace light_shape_details

/// A uniformly distributed point of the light's surface.      pdf_A = 1 / area
inline LightPoint sample_area(const Scene& scene, size_t light, Vec2 u) {
    const LightShape& shape = scene.light_shapes[light];
    if (!shape.parallelogram) return light_shape_details::sample_pieces(scene, light, u);
    Vec3 p = shape.corners[0] + u.x * shape.e1 + u.y * shape.e2;
    return {p, shape.first.n, shape.first.eps, 1 / shape.area};
}
float pdf_area(const Scene& scene, size_t light);

/// A point of the light, (nearly) uniformly distributed in solid angle seen from x. pdf in sr^-1.
///
///   sphere         the cone that it fills
///   two triangles  the two spherical triangles, one chosen by its solid angle
///   more           a triangle chosen by area, then its spherical triangle
///   disk           its bounding square, one side towards x; no sample where it misses the disk
///
/// If x is farther away than two radii, or inside a sphere: by area, which is faster. If x is on
/// the light within rounding, its side is unknown: by area, which contributes almost nothing.
/// source  cone: Shirley, Wang 1991; triangle: Arvo 1995
/// tested by  "consistency: a light's samples agree with its density", "truth: squares from near"
inline LightPoint sample_solid_angle(const Scene& scene, size_t light, Vec3 x, Vec2 u) {
    namespace details = light_shape_details;
    const LightShape& shape = scene.light_shapes[light];
    if (shape.first.kind == Emitter::sphere || details::is_near(shape, x))
        return details::sample_near(scene, light, x, u);
    LightPoint y = sample_area(scene, light, u);
    y.pdf = area_to_solid_angle(y.pdf, x, y.p, y.n);
    return y;
}

/// The density of sample_solid_angle, in sr^-1, for the point y that a ray from x hit.
float pdf_solid_angle(const Scene& scene, size_t light, Vec3 x, const Hit& y);

/// The density of sample_one_light (chapter 10), in sr^-1, for the direction in which a ray from x
/// hit point y of the light; and for direction wi, in which a ray from x hit the sky.
inline float pdf_one_light(const Scene& scene, size_t light, const Hit& x, const Hit& y) {
    return pdf_solid_angle(scene, light, x.p, y);
}
inline float pdf_sky(const Hit& x, Vec3 wi) { return std::max(0.0f, dot(wi, x.n)) / pi; }

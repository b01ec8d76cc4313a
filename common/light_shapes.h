// Points on the surface of a light, drawn by area or by the solid angle under which x sees it.
#pragma once
#include "common/intersect.h"
#include "common/scene.h"

/// A point of a light.
struct LightPoint {
    Vec3 p, n;      // m; n: unit, on the side that shines
    float eps = 0;  // m: how far p may be off the surface
    float pdf = 0;  // m^-2 by area, sr^-1 by solid angle; 0: no point
};

/// Fills scene.light_shapes: areas, centres, and whether two triangles make one parallelogram.
void prepare_light_shapes(Scene& scene);

/// A point of the light's surface, all equally likely.      pdf_A = 1 / area
LightPoint sample_area(const Scene& scene, size_t light, Vec2 u);
float pdf_area(const Scene& scene, size_t light);

/// A point of the light, its directions from x (nearly) all equally likely. pdf in sr^-1.
///
///   sphere         the cone that it fills
///   two triangles  the two spherical triangles, one chosen by its solid angle
///   more           a triangle chosen by area, then its spherical triangle
///   disk           its bounding square; no point where that misses the disk
///
/// Where x is farther away than two radii, and inside a sphere: by area, which is then as good.
/// source  cone: Shirley, Wang 1991; triangle: Arvo 1995
/// tested by  "consistency: a light's samples agree with its density"
LightPoint sample_solid_angle(const Scene& scene, size_t light, Vec3 x, Vec2 u);

/// The density, in sr^-1, with which sample_solid_angle finds the point y that a ray from x met.
float pdf_solid_angle(const Scene& scene, size_t light, Vec3 x, const Hit& y);

/// The same density per solid angle at x:  pdf_w = pdf_A d^2 / cos_y.      0 where y is edge-on.
inline float area_to_solid_angle(float pdf_A, Vec3 x, Vec3 y, Vec3 n_y) {
    Vec3 to_y = y - x;
    float d2 = dot(to_y, to_y), d_cos = std::abs(dot(to_y, n_y));
    return d_cos > 0 ? pdf_A * d2 * (std::sqrt(d2) / d_cos) : 0;
}

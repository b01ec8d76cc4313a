// taught by chapter 16
// A point of the lens, and a time at which the shutter is open.
#pragma once
#include "common/scene/scene.h"

/// Replaces the pinhole's ray by one through a random point of the lens, with the same focus point.
///
///   focus = o + F d / (depth of d);   o' = o + R sqrt(u1) (cos, sin)(2 pi u2);   d' = focus - o'
///
/// F and depths are measured along the camera's axis: the points in focus form a plane.
/// source  Cook, Porter, Carpenter 1984
/// tested by  "truth: circles of confusion", points within 1e-6, radii to 0.1 %
inline Ray through_lens(const Camera& camera, Ray ray, Vec2 u) {
    Vec3 axis = cross(camera.right, camera.up);
    float depth = dot(ray.d, axis) / dot(camera.forward, axis);
    Vec3 focus = ray.o + camera.focal_distance / depth * ray.d;
    Vec3 p = from_cylindrical(camera.lens_radius * std::sqrt(u.x), u.y, 0);
    Vec3 o = ray.o + p.x * camera.right + p.y * camera.up;
    return {o, normalize(focus - o)};
}

/// A uniformly distributed time at which the shutter is open, in s.
///
/// tested by  "truth: how long what moves covers a point", within 5 standard errors
inline float sample_time(const Camera& camera, float u) {
    return std::lerp(camera.shutter_open, camera.shutter_close, u);
}

// The hierarchy of bounding boxes that finds what a ray hits (chapter 05).
//
// scene.h includes this header, and chapter 04 has intersect_triangle() and its like as its own
// lesson: so this header must not include shapes.h; what needs it belongs into bvh.cpp.
#pragma once
#include "common/geometry.h"

struct Bvh {};  // stand-in until chapter 05 is written

Bvh build_bvh(const Geometry& geometry, int threads);
PrimHit closest_hit(const Bvh& bvh, const Geometry& geometry, const Ray& ray);
bool any_hit(const Bvh& bvh, const Geometry& geometry, const Ray& ray);

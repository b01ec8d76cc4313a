// The area lights of a scene, taken apart: what sampling them needs to know beforehand.
#pragma once
#include <cstdint>
#include <vector>

#include "common/base/vec.h"

struct Scene;

/// A primitive of a light, taken apart: a triangle p0 p1 p2, or a sphere or disk of radius r at p0.
struct Emitter {
    enum Kind : uint8_t { triangle, sphere, disk } kind = triangle;
    bool inward = false;  // a sphere that shines inwards
    Vec3 p0, p1, p2;
    Vec3 n;  // unit
    float r = 0;
    float eps = 0;        // m: how far a point of it may be off
    float off_plane = 0;  // m: how far off its plane, for one that is flat
};

/// What sampling an area light needs to know of it beforehand.
struct LightShape {
    Emitter first;   // of its primitives
    float area = 0;  // m^2, of all of them
    Vec3 centre;     // of a sphere around it, m
    float radius = 0;
    bool flat = false;              // one triangle or disk, or a parallelogram
    bool parallelogram = false;     // two triangles that make corners[0] + s e1 + t e2
    Vec3 corners[4], e1, e2;        // one corner after the other; the edges from the first
    std::vector<float> area_up_to;  // running sum over its primitives, where they are more than one
};

/// Primitive number `prim` of the scene, as a part of a light.
Emitter emitter_of(const Scene& scene, uint32_t prim);
/// m^2
float area_of(const Emitter& e);

/// The areas and centres of all lights of the scene, and whether two triangles make one
/// parallelogram; empty for lights without area.
std::vector<LightShape> light_shapes_of(const Scene& scene);

// A point of a surface, ready for shading.
#pragma once
#include "common/material/material.h"

/// A point of a surface, as seen by the ray that found it: n and ng face where it came from.
struct Hit {
    Vec3 p;      // m
    Vec3 n;      // shading normal, unit
    Vec3 ng;     // geometric normal, unit
    float eps;   // m: how far p may be off the surface
    float t;     // in lengths of the ray's d
    float time;  // the ray's
    bool front;  // came from the side of the normal: where it shines, outside of glass
    const Material* material;
    int light;      // into Scene::lights; -1: does not shine
    uint32_t prim;  // into Scene::geometry
};

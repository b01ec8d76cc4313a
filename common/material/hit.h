// A point of a surface, ready for shading.
#pragma once
#include "common/material/material.h"

/// A point of a surface, hit by a ray: n and ng are on the side that the ray came from.
struct Hit {
    Vec3 p;      // m
    Vec3 n;      // shading normal, unit
    Vec3 ng;     // geometric normal, unit
    float eps;   // m: largest distance of p from the surface, by rounding
    float t;     // distance along the ray, in lengths of its d
    float time;  // the ray's
    bool front;  // on the normal's side: where a light emits, outside of glass
    const Material* material;
    int light;      // index into Scene::lights; -1: emits no light
    uint32_t prim;  // index into Scene::geometry
};

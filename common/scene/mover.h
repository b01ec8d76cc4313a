// Shapes that move while the shutter is open.
#pragma once
#include <optional>

#include "common/base/position.h"
#include "common/geometry/bvh.h"
#include "common/geometry/motion.h"
#include "common/material/hit.h"

/// The primitives of one Shape directive that moves, each where it is at time 0, and their way.
struct Mover {
    Mover(const Transform& world_from_object, const Transform& at_end)
        : motion(world_from_object, at_end), object_from_start(inverse(world_from_object)) {}

    Motion motion;                // world from object
    Transform object_from_start;  // object from where the primitives are
    Geometry geometry;
    uint32_t first_prim = 0;  // its number among all: those of Scene::geometry come first
    Bvh bvh;
    Box box;                       // around all places that it comes to
    const Position* at = nullptr;  // where a scene file makes it, for messages

    Transform world_from_start(double time) const { return motion.at(time) * object_from_start; }
};

/// The box around all places that its primitives come to, from time 0 to 1.
Box box_over_time(const Mover& mover);

struct Scene;

/// Replaces x by what the ray meets first among the movers, where that is nearer, at its time.
void intersect_movers(const Scene& scene, const Ray& ray, std::optional<Hit>& x);
bool occluded_by_movers(const Scene& scene, const Ray& ray);

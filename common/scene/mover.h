// Shapes that move while the shutter is open.
#pragma once
#include <memory>

#include "common/geometry/geometry.h"
#include "common/geometry/motion.h"

struct Bvh;
struct Position;

/// The primitives of one Shape directive that moves, each where it is at time 0, and their way.
struct Mover {
    Mover(const Transform& world_from_object, const Transform& at_end)
        : motion(world_from_object, at_end), object_from_start(inverse(world_from_object)) {}

    Motion motion;                // world from object
    Transform object_from_start;  // object from where the primitives are
    Geometry geometry;
    uint32_t first_prim = 0;  // its number among all: those of Scene::geometry come first
    std::shared_ptr<const Bvh> bvh;
    Box box;                       // around all places that it comes to
    const Position* at = nullptr;  // where a scene file makes it, for messages

    Transform world_from_start(double time) const { return motion.at(time) * object_from_start; }
};

/// The box around all places that its primitives come to, from time 0 to 1.
Box box_over_time(const Mover& mover);

// Shapes that move while the shutter is open.
#pragma once
#include <memory>

#include "common/geometry/geometry.h"
#include "common/geometry/transform.h"

struct Bvh;
struct Position;

/// The transform from object to world at each time from 0 to 1, between two that are given.
///
///   M = T R S: moved by T, turned by R, stretched by S; T and S go straight, R around one axis
///
/// source  Higham 1986 (R of R S); as in pbrt-v4
/// tested by  "brute: a mesh with normals of its own is met as the same mesh at rest is"
class Motion {
public:
    Motion(const Transform& start, const Transform& end);

    /// World from object at a time; before 0 as at 0, after 1 as at 1.
    Transform at(double time) const;

    bool turns() const { return degrees_ > 0; }

private:
    Vec3d moved_[2];
    Transform turned_;        // at the start, and from there on:
    Vec3d axis_ = {0, 0, 1};  // of any length
    double degrees_ = 0;      // at most 180, the shorter way round
    Transform stretched_[2];
};

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

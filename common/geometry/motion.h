// How a shape moves while the shutter is open.
#pragma once
#include "common/geometry/transform.h"

/// A rotation: cos(angle / 2), and sin(angle / 2) times the axis.
struct Quaternion {
    double w = 1;
    Vec3d v = {0, 0, 0};
};

/// The transform from object to world at each time from 0 to 1, between two that are given.
///
///   M = T R S: moved by T, turned by R, stretched by S; T and S go straight, R along the arc
///
/// source  Shoemake 1985 (arcs); Higham 1986 (R of R S); as in pbrt-v4
/// tested by  "brute: a mesh with normals of its own is met as the same mesh at rest is"
class Motion {
public:
    Motion(const Transform& start, const Transform& end);

    /// World from object at a time; before 0 as at 0, after 1 as at 1.
    Transform at(double time) const;

    bool turns() const { return turns_; }

private:
    Vec3d moved_[2];
    Quaternion turned_[2];
    Transform stretched_[2];
    bool turns_ = false;
};

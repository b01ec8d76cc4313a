// Triangles cut where others stand on them or pass through them.
#pragma once
#include <array>

#include "common/base/parallel.h"
#include "common/scene/scene.h"

using Polygon = std::vector<Vec3>;  // convex; its corners, counter-clockwise

/// The corners of triangle number `prim`.
std::array<Vec3, 3> corners(const Scene& scene, uint32_t prim);

/// The pieces of each triangle, cut where others stand on it or pass through it: no patch then has
/// light on one side of a wall and dark on the other.
///
/// n log n for n triangles of which each is near few others. Those that it does not come to before
/// `stopped()` stay whole. Spheres and disks hide nothing here (see tessellate.h).
/// tested by  "failure: no light under a wall: patches are cut where it stands"
std::vector<std::vector<Polygon>> cut_at_contacts(const Scene& scene, int threads,
                                                  const Stopped& stopped = {});

// Spheres and disks made meshes, since patches are triangles.
#pragma once
#include "common/scene/scene.h"

/// Puts meshes in place of all spheres and disks, and makes the scene ready again: 512 triangles
/// with the area of the sphere, 32 with that of the disk. Returns how many triangles that makes.
/// Throws InputError for a shape so small that the rounding of corners changes its area.
/// tested by  "identity: spheres and disks made meshes keep area, power and the side that shines",
///            "input: a sphere or disk too small to be cut into triangles is refused"
size_t tessellate(Scene& scene, int threads);

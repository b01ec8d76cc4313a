// What radiosity (chapter 26) needs of a scene: diffuse surfaces alone, and triangles alone.
#pragma once
#include "common/scene/scene.h"

/// Throws InputError for all that has no radiosity: paths are LD*E, lamps have a surface, and some
/// surface absorbs.
/// tested by  "input: what has no radiosity is refused, with its place in the file"
void refuse(const Scene& scene);

/// Puts meshes in place of all spheres and disks, and makes the scene ready again: 512 triangles
/// with the area of the sphere, 32 with that of the disk. Returns how many triangles that makes.
/// Throws InputError for a shape so small that the rounding of corners changes its area.
/// tested by  "identity: spheres and disks made meshes keep area, power and the side that shines"
size_t tessellate(Scene& scene, int threads);

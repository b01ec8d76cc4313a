// Triangle meshes of a pbrt-v4 scene file, put into the scene in world space.
#pragma once
#include "common/geometry/geometry.h"
#include "common/scene_file/ply.h"
#include "common/scene_file/settings.h"

/// Of a sphere or disk: the square of a smaller one is no float.
inline constexpr float least_radius = 1.1e-19f;

/// Throws for a point so far out that squares of areas would overflow a float.
void check_extent(const Params& params, Vec3 p);

/// The mesh of Shape "trianglemesh" in its own space, with all that can be wrong with it checked;
/// or of "bilinearmesh" (4 corners), of which each patch becomes two triangles.
TriangleMesh read_triangle_mesh(Params& params, size_t corners = 3);

/// Adds the mesh, and turns each triangle so that its corners run counter-clockwise on the side
/// that pbrt takes for its outside:
///
///   that of its vertices' normals where it has them, else (p1-p0) x (p2-p0) in its own space,
///   carried along, so that a transform that mirrors does not change sides;
///   `reverse` (ReverseOrientation) turns it to the other side
///
/// Leaves out triangles without area, with a note, and notes the faces left out before. All
/// triangles get the number `shape`.
void add_mesh(const Params& params, const TriangleMesh& mesh, const Transform& world_from_object,
              bool reverse, uint32_t shape, Geometry& geometry, Messages& notes);

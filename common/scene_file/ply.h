// Triangle meshes in PLY files, ASCII and binary.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "common/base/vec.h"
#include "common/scene_file/limits.h"

/// A mesh in its own space.
struct TriangleMesh {
    std::vector<Vec3> positions;
    std::vector<Vec3> normals;      // of the vertices, as in the file; empty or one for each
    std::vector<Vec2> uvs;          // the same; empty where a number is not usable
    std::vector<uint32_t> indices;  // three for each triangle, all < positions.size()
    uint64_t faces_left_out = 0;    // those without three or four corners
};

/// Whether all are numbers from -1e9 to 1e9.
bool are_usable(const std::vector<Vec2>& uvs);

/// Reads the mesh from the bytes of a PLY file. A quad 0 1 2 3 becomes triangles 0 1 2 and 0 2 3; a
/// face of fewer than three corners is left out, as in pbrt; one of more than four is refused,
/// since without it the surface would have a hole. Elements and properties other than x y z, nx ny
/// nz, u v (or s t, texture_u texture_v, texture_s texture_t) and the faces are read over, but for
/// triangle strips, which are refused. A mesh without vertices or faces is refused, as pbrt does.
///
/// file    its name, for messages
/// limits  a mesh beyond them is refused before there is memory for it
/// errors  InputError "file:line:column: error: ..." for the header and an ASCII body,
///         "file: error: ... at byte N" for a binary one
/// source  Turk 1994, "The PLY Polygon File Format"      tested by  "input: PLY ..."
TriangleMesh parse_ply(const std::string& file, const std::string& bytes,
                       const Limits& limits = {});

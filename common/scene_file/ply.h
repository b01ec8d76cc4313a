// Triangle meshes in PLY files, ASCII and binary.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "common/base/vec.h"
#include "common/scene_file/reader.h"

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

/// The types of numbers that a PLY file may have.
struct PlyScalar {
    const char *name, *other_name;
    size_t size;  // bytes
    bool is_float, is_signed;
};
inline constexpr std::array<PlyScalar, 8> ply_scalars = {{{"char", "int8", 1, false, true},
                                                          {"uchar", "uint8", 1, false, false},
                                                          {"short", "int16", 2, false, true},
                                                          {"ushort", "uint16", 2, false, false},
                                                          {"int", "int32", 4, false, true},
                                                          {"uint", "uint32", 4, false, false},
                                                          {"float", "float32", 4, true, true},
                                                          {"double", "float64", 8, true, true}}};
inline constexpr std::array<const char*, 3> ply_formats = {"ascii", "binary_little_endian",
                                                           "binary_big_endian"};

/// Reads the mesh from the bytes of a PLY file. A quad 0 1 2 3 becomes triangles 0 1 2 and 0 2 3;
/// faces of fewer than three or more than four corners are left out, as in pbrt. Elements and
/// properties other than x y z, nx ny nz, u v (or s t, texture_u texture_v, texture_s texture_t)
/// and the faces are read over. A mesh without vertices or faces is refused, as pbrt does.
///
/// file    its name, for messages
/// limits  a mesh beyond them is refused before there is memory for it
/// errors  InputError "file:line:column: error: ..." for the header and an ASCII body,
///         "file: error: ... at byte N" for a binary one
/// source  Turk 1994, "The PLY Polygon File Format"      tested by  "input: PLY ..."
TriangleMesh parse_ply(const std::string& file, const std::string& bytes,
                       const Limits& limits = {});

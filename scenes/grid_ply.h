// A grid of points with normals as a binary PLY of triangles, for the programs that write meshes.
#pragma once
#include <cstdint>
#include <functional>
#include <string>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/vec.h"
#include "common/render/options.h"

struct GridPoint {
    Vec3 p, n;
};

template <typename T>
void append(std::string& bytes, T value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// The points (i, j) of a grid, each cell cut into two triangles. `wraps`: the last row and column
/// of cells close the grid to a ring.
template <class PointAt>
std::string grid_ply(int rows, int columns, bool wraps, const PointAt& point_at) {
    int cells_i = rows - !wraps, cells_j = columns - !wraps;
    std::string ply = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                      std::to_string(rows * columns) +
                      "\nproperty float x\nproperty float y\nproperty float z\n"
                      "property float nx\nproperty float ny\nproperty float nz\nelement face " +
                      std::to_string(2 * cells_i * cells_j) +
                      "\nproperty list uchar int vertex_indices\nend_header\n";
    for (int i = 0; i < rows; i++) {
        for (int j = 0; j < columns; j++) append(ply, point_at(i, j));
    }
    for (int i = 0; i < cells_i; i++) {
        for (int j = 0; j < cells_j; j++) {
            int i1 = (i + 1) % rows, j1 = (j + 1) % columns;
            int32_t a = i * columns + j, b = i1 * columns + j, c = i1 * columns + j1,
                    d = i * columns + j1;
            for (int32_t corner : {a, c, b, a, d, c}) {
                if (corner == a) append(ply, uint8_t{3});
                append(ply, corner);
            }
        }
    }
    return ply;
}

/// The program around it: FILE.ply is what the command line names.
inline int write_mesh(int argc, char** argv, const std::function<std::string()>& make) {
    return run_program([&] {
        if (argc != 2) throw UsageError("error: the file to write is needed: FILE.ply");
        write_file_atomically(argv[1], make());
        return 0;
    });
}

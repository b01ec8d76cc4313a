// Writes the mesh of knot.pbrt: a ribbed tube around a (2,3) torus knot, as a binary PLY.
// usage: make_knot FILE.ply
#include <cstdint>
#include <string>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/vec.h"
#include "common/program/options.h"

namespace {

constexpr int along = 1152, around = 64;  // 2 x 1152 x 64 = 147,456 triangles

// In double, then rounded: the same with every library.
float sine(float x) { return static_cast<float>(std::sin(double{x})); }
float cosine(float x) { return static_cast<float>(std::cos(double{x})); }

Vec3 knot(float t) {
    float r = 1 + 0.45f * cosine(3 * t);
    return {r * cosine(2 * t), 0.45f * sine(3 * t), r * sine(2 * t)};
}

Vec3 tube(float s, float phi) {
    float t = 2 * pi * s;
    Vec3 tangent = normalize(knot(t + 1e-3f) - knot(t - 1e-3f));
    Vec3 side = normalize(cross(tangent, {0, 1, 0})), up = cross(side, tangent);
    float radius = 0.24f + 0.02f * cosine(8 * phi + 40 * t);
    return 1.15f * (knot(t) + radius * (cosine(phi) * side + sine(phi) * up));
}

template <typename T>
void append(std::string& bytes, T value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string knot_ply() {
    std::string ply = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                      std::to_string(along * around) +
                      "\nproperty float x\nproperty float y\nproperty float z\n"
                      "property float nx\nproperty float ny\nproperty float nz\nelement face " +
                      std::to_string(2 * along * around) +
                      "\nproperty list uchar int vertex_indices\nend_header\n";
    for (int i = 0; i < along; i++) {
        for (int j = 0; j < around; j++) {
            float s = static_cast<float>(i) / along, phi = 2 * pi * static_cast<float>(j) / around;
            Vec3 p = tube(s, phi), ds = tube(s + 1e-3f, phi) - tube(s - 1e-3f, phi);
            Vec3 dphi = tube(s, phi + 1e-2f) - tube(s, phi - 1e-2f);
            append(ply, p);
            append(ply, normalize(cross(dphi, ds)));
        }
    }
    for (int i = 0; i < along; i++) {
        for (int j = 0; j < around; j++) {
            int i1 = (i + 1) % along, j1 = (j + 1) % around;
            int32_t a = i * around + j, b = i1 * around + j, c = i1 * around + j1,
                    d = i * around + j1;
            for (int32_t corner : {a, c, b, a, d, c}) {
                if (corner == a) append(ply, uint8_t{3});
                append(ply, corner);
            }
        }
    }
    return ply;
}

}  // namespace

int main(int argc, char** argv) {
    return run_program([&] {
        std::string file;
        parse_options(argc, argv, "FILE.ply", "Writes the mesh of knot.pbrt.", {},
                      [&](const std::string& word) { file = word; });
        if (file.empty()) throw UsageError("error: a file to write is needed");
        write_file_atomically(file, knot_ply());
        return 0;
    });
}

// Writes the surface of the water of pool.pbrt: a sheet of ripples, as a binary PLY.
// usage: make_pool FILE.ply
#include <cstdint>
#include <string>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/vec.h"
#include "common/program/options.h"

namespace {

constexpr int cells = 96;  // in each direction: 2 x 96 x 96 = 18,432 triangles
constexpr double side = 4;

/// Three waves: the sum of a sin(k.x + phase), and its slopes.
struct Ripple {
    double height, dx, dz;
};
Ripple ripple(double x, double z) {
    constexpr double waves[3][4] = {
        {0.024, 5.1, 3.3, 0.0}, {0.016, -3.2, 6.9, 1.7}, {0.010, 8.7, -5.9, 4.1}};
    Ripple r = {0, 0, 0};
    for (const auto& [a, kx, kz, phase] : waves) {
        r.height += a * std::sin(kx * x + kz * z + phase);
        r.dx += a * kx * std::cos(kx * x + kz * z + phase);
        r.dz += a * kz * std::cos(kx * x + kz * z + phase);
    }
    return r;
}

template <typename T>
void append(std::string& bytes, T value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string pool_ply() {
    constexpr int points = cells + 1;
    std::string ply = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                      std::to_string(points * points) +
                      "\nproperty float x\nproperty float y\nproperty float z\n"
                      "property float nx\nproperty float ny\nproperty float nz\nelement face " +
                      std::to_string(2 * cells * cells) +
                      "\nproperty list uchar int vertex_indices\nend_header\n";
    for (int i = 0; i < points; i++) {
        for (int j = 0; j < points; j++) {
            double x = side * (double{1} * i / cells - 0.5),
                   z = side * (double{1} * j / cells - 0.5);
            Ripple r = ripple(x, z);
            append(ply, Vec3{static_cast<float>(x), static_cast<float>(r.height),
                             static_cast<float>(z)});
            append(ply, normalize({static_cast<float>(-r.dx), 1, static_cast<float>(-r.dz)}));
        }
    }
    for (int i = 0; i < cells; i++) {
        for (int j = 0; j < cells; j++) {
            int32_t a = i * points + j, b = a + points;
            for (int32_t corner : {a, a + 1, b + 1, a, b + 1, b}) {
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
        parse_options(argc, argv, "FILE.ply", "Writes the water of pool.pbrt.", {},
                      [&](const std::string& word) { file = word; });
        if (file.empty()) throw UsageError("error: a file to write is needed");
        write_file_atomically(file, pool_ply());
        return 0;
    });
}

// Writes the surface of the water of pool.pbrt: a sheet of ripples, as a binary PLY.
// usage: make_pool FILE.ply
#include "scenes/grid_ply.h"

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

GridPoint point_at(int i, int j) {
    double x = side * (double{1} * i / cells - 0.5), z = side * (double{1} * j / cells - 0.5);
    Ripple r = ripple(x, z);
    Vec3 p = {static_cast<float>(x), static_cast<float>(r.height), static_cast<float>(z)};
    return {p, normalize({static_cast<float>(-r.dx), 1, static_cast<float>(-r.dz)})};
}

}  // namespace

int main(int argc, char** argv) {
    return write_mesh(argc, argv, [] { return grid_ply(cells + 1, cells + 1, false, point_at); });
}

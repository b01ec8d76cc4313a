// Writes the mesh of knot.pbrt: a ribbed tube around a (2,3) torus knot, as a binary PLY.
// usage: make_knot FILE.ply
#include "scenes/grid_ply.h"

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

GridPoint point_at(int i, int j) {
    float s = static_cast<float>(i) / along, phi = 2 * pi * static_cast<float>(j) / around;
    Vec3 p = tube(s, phi), ds = tube(s + 1e-3f, phi) - tube(s - 1e-3f, phi);
    Vec3 dphi = tube(s, phi + 1e-2f) - tube(s, phi - 1e-2f);
    return {p, normalize(cross(dphi, ds))};
}

}  // namespace

int main(int argc, char** argv) {
    return write_mesh(argc, argv, [] { return grid_ply(along, around, true, point_at); });
}

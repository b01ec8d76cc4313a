// Writes the meshes of the gallery, and its sky: what gallery/*.pbrt include.
// usage: make_gallery FOLDER
#include <array>
#include <sstream>

#include "common/picture/image.h"
#include "scenes/grid_ply.h"

namespace {

using Profile = std::vector<std::array<double, 2>>;  // radius and height, from below
/// The point of a smooth curve through the profile (Catmull and Rom's), and its direction.
std::array<double, 4> on_curve(const Profile& p, double t) {
    size_t i = std::min(static_cast<size_t>(t), p.size() - 2);
    double s = t - static_cast<double>(i);
    std::array<double, 4> result = {};
    for (size_t k = 0; k < 2; k++) {
        double a = p[i > 0 ? i - 1 : 0][k], b = p[i][k], c = p[i + 1][k];
        double d = p[std::min(i + 2, p.size() - 1)][k];
        double m0 = (c - a) / 2, m1 = (d - b) / 2;
        result[k] = b + s * (m0 + s * (3 * (c - b) - 2 * m0 - m1 + s * (2 * (b - c) + m0 + m1)));
        result[k + 2] =
            m0 + s * (2 * (3 * (c - b) - 2 * m0 - m1) + 3 * s * (2 * (b - c) + m0 + m1));
    }
    return result;
}

/// Turns a profile around the y axis; its outside is on the right of the way along it.
void lathe(const std::string& folder, const std::string& name, const std::string& text) {
    std::istringstream numbers(text);
    Profile profile;
    for (std::array<double, 2> p; numbers >> p[0] >> p[1]; numbers.ignore(1)) profile.push_back(p);
    constexpr int around = 128, per_segment = 12;
    int rows = per_segment * (static_cast<int>(profile.size()) - 1) + 1;
    auto point_at = [&](int i, int j) {
        auto [r, y, dr, dy] = on_curve(profile, double{1} * i / per_segment);
        double phi = 2 * std::numbers::pi * (j % around) / around, c = std::cos(phi);
        Vec3d p = {std::max(r, 1e-5) * c, y, std::max(r, 1e-5) * std::sin(phi)};
        Vec3d n = {dy * c, -dr, dy * std::sin(phi)};
        if (dr == 0 && dy == 0) n = {0, r < 1e-3 && i > 0 ? 1.0 : -1.0, 0};
        return GridPoint{to_vec3(p), to_vec3(normalize(n))};
    };
    write_file_atomically(folder + '/' + name + ".ply",
                          grid_ply(rows, around + 1, false, point_at));
}

/// A field of hills: the heights over a rectangle of the ground.
template <class Height>
void field(const std::string& folder, const std::string& name, double x0, double z0, double x1,
           double z1, int cells, const Height& height) {
    auto point_at = [&](int i, int j) {
        double x = x0 + (x1 - x0) * i / cells, z = z0 + (z1 - z0) * j / cells, e = 1e-3;
        double dx = (height(x + e, z) - height(x - e, z)) / (2 * e);
        double dz = (height(x, z + e) - height(x, z - e)) / (2 * e);
        return GridPoint{to_vec3(Vec3d{x, height(x, z), z}),
                         to_vec3(normalize(Vec3d{-dx, 1, -dz}))};
    };
    write_file_atomically(folder + '/' + name + ".ply",
                          grid_ply(cells + 1, cells + 1, false, point_at));
}

double water(double x, double z) {
    return .022 * std::sin(3.1 * x + 2.3 * z) + .016 * std::sin(4.9 * z - 2.2 * x + 1.7) +
           .010 * std::sin(6.7 * x - 3.9 * z + 4.1) + .006 * std::sin(8.1 * x + 7.3 * z + 2.2) +
           .004 * std::sin(9.7 * z - 11 * x + .6);
}

double hills(double x, double z) {
    double far = std::clamp((z - 4) / 40, 0.0, 1.0);
    return far * (3.2 * std::sin(0.11 * x + 0.4) * std::sin(0.13 * z) +
                  1.3 * std::sin(0.31 * x + 0.23 * z) + 0.3 * std::sin(1.1 * x - 0.7 * z)) +
           0.03 * std::sin(1.9 * x + 0.6) * std::sin(2.3 * z) - 0.03;
}

double shore(double x, double z) {
    double up = std::clamp((z - 12) / 30, 0.0, 1.0);
    return up * up * (9 + 4 * std::sin(0.11 * x + 1) + 2 * std::sin(0.23 * x + 0.2 * z)) +
           std::clamp((z - 10.5) / 1.5, -1.0, 1.0) * 0.4;
}

/// A sunset: longitude over latitude, the zenith on top.
Image evening() {
    Image sky(512, 256);
    const Vec3d sun = normalize(Vec3d{-0.55, 0.16, 1});
    for (int j = 0; j < sky.height; j++) {
        for (int i = 0; i < sky.width; i++) {
            double theta = double{pi} * (j + 0.5) / 256, phi = double{pi} * (i + 0.5) / 256;
            double up = std::cos(theta), x = std::sin(theta) * std::cos(phi);
            double z = -std::sin(theta) * std::sin(phi), h = std::max(0.0, up);
            double near = std::pow(std::max(0.0, dot({x, up, z}, sun)), 8);
            double clouds = 0, d = h + 0.12;
            for (double k = 3; k < 60; k *= 1.9)
                clouds += std::sin(k * x / d + 2 * k) * std::sin(k * z / d + k * k) / std::sqrt(k);
            float c = static_cast<float>(std::clamp(0.5 * clouds, 0.0, 1.0) * std::min(1.0, 6 * h));
            float glow = static_cast<float>(near), low = static_cast<float>(std::exp(-5 * h));
            Rgb L = (1 - low) * Rgb{0.12f, 0.2f, 0.45f} + low * Rgb{0.9f, 0.5f, 0.35f} +
                    glow * Rgb{1.6f, 0.8f, 0.3f};
            L = 0.75f * ((1 - 0.7f * c) * L + 0.7f * c * (0.5f + glow) * Rgb{1.1f, 0.7f, 0.6f});
            if (near > std::pow(std::cos(0.025), 8)) L = {1500, 950, 500};
            sky.at(i, j) = up < 0 ? Rgb{0.1f, 0.08f, 0.07f} : L;
        }
    }
    return sky;
}

}  // namespace

int main(int argc, char** argv) {
    return run_program([&] {
        if (argc != 2) throw UsageError("usage: make_gallery FOLDER");
        const std::string folder = argv[1], foot = "0 0, .3 0, .33 .04, .32 .1, .24 .16, .26 .2, ";
        lathe(folder, "vase",
              "0 0, .25 0, .28 .05, .45 .4, .42 .75, .2 1, .17 1.15, .25 1.25, .23 1.26, .14 1.15, "
              ".17 1, .38 .75, .4 .4, .2 .06, 0 .05");
        lathe(folder, "pawn", foot + ".15 .32, .1 .5, .18 .56, .12 .6, .19 .72, .13 .85, 0 .9");
        lathe(folder, "rook", foot + ".19 .35, .17 .7, .25 .78, .25 1, .18 1, .17 .92, 0 .92");
        lathe(folder, "bishop",
              foot + ".15 .4, .1 .8, .19 .86, .12 .9, .17 1.05, .1 1.22, .04 1.3, 0 1.36");
        lathe(folder, "queen",
              foot + ".16 .45, .11 1, .2 1.07, .13 1.12, .22 1.4, .16 1.42, .05 1.5, 0 1.6");
        lathe(folder, "wineglass",
              "0 0, .36 0, .37 .02, .2 .05, .05 .12, .04 .3, .04 .6, .08 .72, .3 .9, .4 1.2, .34 "
              "1.7, .32 1.72, .3 1.7, .365 1.2, .27 .94, .1 .82, 0 .8");
        lathe(folder, "bottle",
              "0 .05, .3 0, .4 .04, .42 .2, .42 1, .4 1.35, .2 1.7, .14 1.9, .14 2.3, .13 2.35, "
              ".11 2.3, .11 1.9, .17 1.68, .36 1.33, .38 1, .38 .2, .34 .1, 0 .12");
        field(folder, "water", -3, -3, 3, 3, 160, water);
        field(folder, "hills", -130, -10, 130, 140, 500, hills);
        field(folder, "shore", -60, 6, 60, 70, 240, shore);
        write_image(folder + "/evening.pfm", evening(), "");
        return 0;
    });
}

// Law: lights may be as near and as small as floats allow, for every method that samples lights.
#include <cstdio>

#include "common/geometry/transform.h"
#include "common/scene/prepare.h"
#include "tests/laws/laws.h"

namespace {

/// The methods that sample lights well, however near or far. 09, 14 and 15 differ where there is
/// one light: others sample it as one of these does.
std::vector<NamedMethod> that_sample_lights(const Scene& scene, bool all = true) {
    std::vector<NamedMethod> methods = methods_for(scene);
    std::erase_if(methods, [&](const NamedMethod& m) {
        bool differs = m.name == "09" || m.name == "14" || m.name == "15";
        return m.search != LightSearch::light_sampling || m.name == "09-area" ||
               m.name == "14-balance" || !(all || differs);
    });
    return methods;
}

/// A small white square around the origin, facing +y, under black lights of radiance 1. So small,
/// that its points are known to better than 1e-9, however near the light is.
Scene patch_under(const std::string& light) {
    std::string patch =
        "AttributeBegin Material \"diffuse\" \"rgb reflectance\" [1 1 1]\n"
        "Scale 0.001 1 0.001 ";
    Scene scene = world_of(patch + square(0, true) + "AttributeEnd\n" + shining + light);
    scene.max_depth = 1;
    return scene;
}

/// The triangles of these corners, all at height h, facing down.
std::string triangles(const std::string& indices, double h, const std::vector<Vec2>& corners) {
    std::string text =
        "Shape \"trianglemesh\" \"integer indices\" [" + indices + "] \"point3 P\" [";
    for (Vec2 p : corners) {
        for (double x : {double{p.x}, h, double{p.y}}) text += digits(x, 9) + " ";
    }
    return text + "]\n";
}
/// The unit square at height h, its first corner at x, z.
std::string unit_square_at(double h, Vec2 p) {
    float x = p.x, z = p.y;
    return triangles("0 2 1 0 3 2", h, {{x, z}, {x, z + 1}, {x + 1, z + 1}, {x + 1, z}});
}

/// The normal of the patch.
Vec3 up_of(const Scene& scene) { return scene.geometry.facet_normals[0]; }
/// Sees the middle of the patch from so near that no light at this height is in between.
Ray onto_patch(const Scene& scene, double h) {
    const auto& p = scene.geometry.positions;
    Vec3 middle = 0.5f * (p[0] + p[2]);
    return {middle + static_cast<float>(h / 4) * up_of(scene), -up_of(scene)};
}

/// Lambert's formula, in double: the irradiance of the light's triangles, all above the horizon.
///
///   E = 1/2 sum over edges a b of  angle(a, b) n . (a x b) / |a x b|
double irradiance_of_triangles(const Scene& scene, Vec3 x) {
    const Geometry& g = scene.geometry;
    Vec3d n = Vec3d(up_of(scene)), from = Vec3d(x);
    double E = 0;
    for (size_t i = 2; i < g.triangles.size(); i++) {  // 0 and 1: the patch
        for (size_t k = 0; k < 3; k++) {
            Vec3d a = Vec3d(g.positions[g.triangles[i].v[k]]) - from;
            Vec3d b = Vec3d(g.positions[g.triangles[i].v[(k + 1) % 3]]) - from;
            Vec3d side = cross(a, b);
            double sine = std::sqrt(dot(side, side));
            if (sine > 0) E += std::atan2(sine, dot(a, b)) * dot(n, side) / sine / 2;
        }
    }
    return std::abs(E) / std::sqrt(dot(n, n));
}

/// The same for a disk of radius 1 at height h, its centre aside by d; without cancellation.
double irradiance_of_disk(double h, double d) {
    double a = h * h + d * d - 1, s = std::sqrt(a * a + 4 * h * h);
    return pi_exact / 2 * (a > 0 ? 4 * h * h / (s * (s + a)) : 1 - a / s);
}

/// The irradiance at the middle of the patch, from Sobol points: its error is what the `scrambles`
/// of them show, far below that of as many random numbers.
RunningStats measure(const Scene& scene, const Method& trace, const Ray& ray, uint32_t scrambles,
                     uint32_t points) {
    RunningStats stats;
    Sampler sampler(SamplerType::sobol, 1, points);
    Recorder recorder;
    for (uint32_t scramble = 0; scramble < scrambles; scramble++) {
        double sum = 0;
        for (uint32_t i = 0; i < points; i++) {
            sampler.start(scramble, i);
            sum += static_cast<double>(trace(scene, ray, sampler, recorder).g);
        }
        stats.add(pi_exact * sum / points);
    }
    return stats;
}

/// All methods find this irradiance under a light at the height h.
void check_near(const Scene& scene, double h, double truth, double relative_se = 4e-3) {
    CAPTURE(h);
    for (const NamedMethod& row : that_sample_lights(scene, false)) {
        CAPTURE(row.name);
        RunningStats s = measure(scene, method(row.name, scene), onto_patch(scene, h), 512, 16);
        check_bounded(s, truth, relative_se);
    }
}
constexpr double heights[] = {1e-1, 1e-3, 1e-5, 1e-7};

}  // namespace

TEST_SUITE("law: near lights") {
    TEST_CASE("truth: squares from near") {
        for (Vec2 corner : {Vec2{-0.5f, -0.5f},       // under the middle, where two triangles meet
                            Vec2{-0.25f, -0.25f},     // under one diagonal
                            Vec2{-0.25f, -0.75f},     // under the other
                            Vec2{-0.1875f, -0.4f},    // under neither
                            Vec2{0, -0.375f},         // under an edge
                            Vec2{0, 0},               // under a corner
                            Vec2{0.0078125f, -0.4f},  // beside an edge
                            Vec2{0.125f, 0.125f}})    // beside a corner
            for (double h : heights) {
                Scene scene = patch_under(unit_square_at(h, corner));
                REQUIRE(scene.light_shapes[0].parallelogram);
                check_near(scene, h, irradiance_of_triangles(scene, {}));
            }
    }

    TEST_CASE("truth: triangles from near") {
        // A triangle; two that are no parallelogram; one that is seen very thin.
        const std::vector<std::pair<std::string, std::vector<Vec2>>> shapes = {
            {"0 2 1", {{-0.3f, -0.4f}, {0.2f, 0.7f}, {0.6f, -0.2f}}},
            {"0 2 1 0 3 2", {{-0.5f, -0.3f}, {-0.4f, 0.2f}, {0.6f, 0.7f}, {0.1f, -0.5f}}},
            {"0 2 1", {{-1, -1e-4f}, {0, 3e-4f}, {1, -2e-4f}}}};
        for (const auto& [indices, corners] : shapes)
            for (double h : heights) {
                Scene scene = patch_under(triangles(indices, h, corners));
                check_near(scene, h, irradiance_of_triangles(scene, {}));
            }
    }

    TEST_CASE("truth: disks and balls from near") {
        for (double d : {0.0, 0.5, 1.0, 1.0078125, 1.4})
            for (double h : heights) {
                // Where the rim is, is known to 6e-8: right under it no better than to 6e-8 / h.
                if (d == 1 && h < 1e-4) continue;
                CAPTURE(d);
                Scene scene = patch_under("Translate " + digits(d, 9) + " " + digits(h, 9) +
                                          " 0 Rotate 90 1 0 0 Shape \"disk\"\n");
                check_near(scene, h, irradiance_of_disk(h, d), 1e-2);
            }
        for (double gap : {0.3, 0.01, 1e-3, 1e-4, 3e-6}) {
            Scene scene =
                patch_under("Translate 0 " + digits(1 + gap, 9) + " 0 Shape \"sphere\"\n");
            double centre = double{scene.geometry.spheres[0].c.y};
            check_near(scene, gap, pi_exact / (centre * centre), 1e-2);
        }
    }

    TEST_CASE("identity: no shadow ray goes to light that would not come, or not be reflected") {
        // The lamp is behind the wall and shines towards it, or in front of it and shines away:
        // each path is one ray to the wall, and one on.
        for (std::string place : {"-1", "9"}) {
            CAPTURE(place);
            Scene scene =
                world_of("AttributeBegin Rotate -90 1 0 0 Scale 9 1 9 " + square(0, true) +
                             "AttributeEnd\n" + shining + "Rotate -90 1 0 0 Translate 0 " + place +
                             " 0 " + square(0, true),
                         8);
            scene.max_depth = 1;
            for (const NamedMethod& row : that_sample_lights(scene)) {
                CAPTURE(row.name);
                Rendering r = film_of(scene, method(row.name, scene), 4);
                CHECK(r.stats.rays == 2 * 8 * 8 * 4);
                CHECK(r.film.mean() == 0);
            }
        }
    }

    /// Every method brings numbers along the ray.
    void check_finite(const Scene& scene, const Ray& ray) {
        for (const NamedMethod& row : that_sample_lights(scene)) {
            CAPTURE(row.name);
            CHECK(std::isfinite(repeat(scene, ray, method(row.name, scene), 200).mean()));
        }
    }

    TEST_CASE(
        "failure: on a light, but for rounding, it gives nothing by light sampling, and no NaN") {
        for (std::string h : {"1e-18", "1e-38", "1e-44", "0"}) {
            for (std::string shape : {unit_square_at(std::stod(h), {-0.3f, -0.4f}),
                                      triangles("0 2 1", std::stod(h), {{-1, 0}, {1, -1}, {0, 2}}),
                                      "Translate 0 " + h + " 0 Rotate 90 1 0 0 Shape \"disk\"\n",
                                      std::string("Translate 0 1 0 Shape \"sphere\"\n")}) {
                CAPTURE(h);
                CAPTURE(shape);
                Scene scene = patch_under(shape);
                Ray ray = onto_patch(scene, 1e-3);
                ray.o = ray.o + 1e-3f * ray.d;
                check_finite(scene, ray);
            }
        }
    }

    TEST_CASE("failure: the brightest and smallest lights, by every method: no NaN") {
        for (std::string r : {"1.1e-18", "1e-17", "1e-10", "4e8"}) {
            CAPTURE(r);
            std::string rough = "Material \"conductor\" \"float roughness\" 0.1 Scale 1e6 1 1e6 ";
            std::string light =
                "AreaLightSource \"diffuse\" \"rgb L\" [1e15 1e15 1e15] "
                "Translate 0 2e3 0 Shape \"sphere\" \"float radius\" ";
            check_finite(world_of("AttributeBegin " + rough + square(0, true) + "AttributeEnd " +
                                  light + r + " Translate 30 0 0 Shape \"sphere\""),
                         {{0, 5, -9}, {0, -0.6f, 0.8f}});
        }
    }
}

// Solid angles, and points drawn on lights of every shape.
#include "common/light/light_shapes.h"

#include <doctest/doctest.h>

#include <array>
#include <set>

#include "common/light/solid_angle.h"
#include "tests/support/gates.h"
#include "tests/support/scenes.h"

namespace {

constexpr double pi_exact = std::numbers::pi;
constexpr float below_one = 0x1.fffffep-1f;

Vec3d unit(Vec3 a) { return normalize(Vec3d(a)); }
double triangle_angle(Vec3 a, Vec3 b, Vec3 c) {
    return triangle_solid_angle(unit(a), unit(b), unit(c));
}

double rectangle_angle(float width, float height, float distance) {
    float x = width / 2, y = height / 2, d = distance;
    return triangle_angle({-x, -y, d}, {x, -y, d}, {x, y, d}) +
           triangle_angle({-x, -y, d}, {x, y, d}, {-x, y, d});
}

double relative_error(double value, double truth) { return std::abs(value / truth - 1); }

/// chi^2 of directions against the solid angles of the 64 triangles that a b c is cut into.
template <class Sample>
double chi_square_of_triangle(Vec3 a, Vec3 b, Vec3 c, Sample sample) {
    constexpr int n = 8, samples = 100000;
    std::array<double, n * n> counts{}, expected{};
    auto corner = [&](int i, int j) {
        float s = static_cast<float>(i) / n, t = static_cast<float>(j) / n;
        return a + s * (b - a) + t * (c - a);
    };
    // Row i, column 2 j: the triangle with its corner at (i, j); column 2 j + 1: the one across.
    auto cell = [](int i, int j, bool across) {
        return static_cast<size_t>(i * (2 * n - i) + 2 * j + across);
    };
    double omega = 0;
    for (int i = 0; i < n; i++)
        for (int j = 0; i + j < n; j++)
            for (bool across : {false, true}) {
                if (across && i + j == n - 1) continue;
                int k = across ? 1 : 0;
                double part =
                    triangle_angle(corner(i + k, j + k), corner(i + 1, j), corner(i, j + 1));
                expected[cell(i, j, across)] = part;
                omega += part;
            }
    CHECK(relative_error(omega, triangle_angle(a, b, c)) < 1e-4);
    for (double& e : expected) e *= samples / omega;
    Sampler random = random_numbers(1);
    for (int k = 0; k < samples; k++) {
        Vec3 w = sample(random.u2());
        // Where w meets the plane of a b c, as a + s (b - a) + t (c - a).
        Vec3 n_abc = cross(b - a, c - a);
        Vec3 p = dot(n_abc, a) / dot(n_abc, w) * w - a;
        float s = dot(cross(p, c - a), n_abc) / dot(n_abc, n_abc) * n;
        float t = dot(cross(b - a, p), n_abc) / dot(n_abc, n_abc) * n;
        int i = std::clamp(static_cast<int>(s), 0, n - 1);
        int j = std::clamp(static_cast<int>(t), 0, n - 1 - i);
        bool across = s - static_cast<float>(i) + t - static_cast<float>(j) > 1 && i + j < n - 1;
        counts[cell(i, j, across)]++;
    }
    return chi_square(counts, expected);
}
/// A scene whose only light is this shape, in front of nothing else.
Scene light_of(const std::string& shape) {
    return world_of("AreaLightSource \"diffuse\"\n" + shape);
}

const std::string quad = "Translate 0 1 0 Scale 0.5 1 0.5 " + square(0, false);  // 1 x 1, at y = 1
const std::string tilted_quad = "Rotate 35 1 2 3 Translate 0 1 0 " + square(0, false);
const std::string sphere = "Translate 0 1.5 0 Shape \"sphere\" \"float radius\" 0.5";
const std::string disk = "Translate 0 1 0 Rotate 90 1 0 0 Shape \"disk\" \"float radius\" 0.5";
const std::string triangle =
    "Shape \"trianglemesh\" \"point3 P\" [-0.5 1 0  0.7 1.1 -0.3  0 0.9 0.8]";
const std::string kite =  // two triangles, but no parallelogram
    "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3]"
    " \"point3 P\" [0 1 -1  0.5 1 0.5  0 1 1.5  -1 1 0]";
const std::string mesh =  // a roof over the origin, with triangles of very different areas
    "Shape \"trianglemesh\" \"integer indices\" [0 1 4 1 2 4 2 3 4 3 0 4]"
    " \"point3 P\" [-1 1 -1  1 1 -1  1 1 1  -0.2 1 0.2  0.1 1.5 0.1]";

const std::vector<std::pair<std::string, std::string>> shapes = {
    {"quad", quad}, {"tilted quad", tilted_quad}, {"sphere", sphere},
    {"disk", disk}, {"triangle", triangle},       {"kite", kite},
    {"mesh", mesh}};

const std::vector<Vec3> places = {{0, 0, 0}, {0.4f, 0.2f, -0.3f}, {0.1f, 0.9f, 0}, {3, -4, 2}};

/// What the light gives a receiver at x with normal n, drawn either way: mean and variance.
RunningStats irradiance(const Scene& scene, Vec3 x, Vec3 n, bool by_area, int samples) {
    RunningStats stats;
    Sampler random = random_numbers(1);
    for (int i = 0; i < samples; i++) {
        Vec2 u = random.u2();
        LightPoint y = by_area ? sample_area(scene, 0, u) : sample_solid_angle(scene, 0, x, u);
        double pdf = static_cast<double>(by_area ? area_to_solid_angle(y.pdf, x, y.p, y.n) : y.pdf);
        Vec3 wi = normalize(y.p - x);
        bool seen = pdf > 0 && dot(wi, n) > 0 && dot(wi, y.n) < 0;
        stats.add(seen ? static_cast<double>(dot(wi, n)) / pdf : 0);
    }
    return stats;
}

double off(Vec3 a, Vec3 b) { return static_cast<double>(length(a - b)); }

}  // namespace

TEST_SUITE("solid angle") {
    TEST_CASE("truth: solid angles of triangles and rectangles") {
        CHECK(relative_error(triangle_angle({1, 0, 0}, {0, 1, 0}, {0, 0, 1}), pi_exact / 2) <
              1e-12);
        CHECK(relative_error(triangle_angle({0, 0, 1}, {1, 0, 1}, {0, 1, 1}), 0.3398369094541) <
              1e-12);
        CHECK(relative_error(triangle_angle({-1, -1, 2}, {1, -1, 2}, {0, 1, 2}), 0.4252343249688) <
              1e-12);
        CHECK(relative_error(triangle_angle({0, 0, 1}, {1, 0, 1}, {1, 1e-3f, 1}),
                             0.000292893180108) < 1e-7);
        CHECK(relative_error(rectangle_angle(1, 1, 1), 0.8054316831613) < 1e-12);
        CHECK(relative_error(rectangle_angle(1, 1, 0.5f), 2.094395102393) < 1e-12);  // 4 pi / 6
        CHECK(relative_error(rectangle_angle(2, 1, 1), 1.287002217587) < 1e-12);
        CHECK(relative_error(rectangle_angle(1, 1, 10), 0.009975072683099) < 1e-12);
        CHECK(relative_error(rectangle_angle(1, 1, 0.001f), 6.271871617537) < 1e-9);
        // Around the viewer: half of all.
        CHECK(relative_error(triangle_angle({1, 0, 0}, {0, 1, 0}, {-1, -1, 0}), 2 * pi_exact) <
              1e-12);
        CHECK(triangle_angle({1, 0, 0}, {2, 1, 0}, {1, 1, 0}) == 0);  // edge-on
    }

    TEST_CASE("truth: solid angle of a sphere, near and far") {
        for (auto [distance, omega] : {std::pair{2.0f, 0.8417872144769},
                                       {10.0f, 0.031494861523},
                                       {1000.0f, 3.141593438988e-6},
                                       {10000.0f, pi_exact * 1e-8}}) {
            double cone = 1 / static_cast<double>(pdf_cone(1 / (distance * distance)));
            CHECK(relative_error(cone, omega) < 1e-6);
        }
    }

    TEST_CASE("density: cone") {
        for (float sin2 : {1e-8f, 0.25f, 0.9999f}) {
            std::array<double, 100> counts{};
            Sampler random = random_numbers(1);
            for (int i = 0; i < 100000; i++) {
                Vec3 w = sample_cone(sin2, random.u2());
                double h = static_cast<double>(length_squared(w - Vec3{0, 0, 1})) / 2;
                double u = h / static_cast<double>(one_minus_cos(sin2));
                double phi = std::atan2(static_cast<double>(w.y), static_cast<double>(w.x));
                size_t row = std::min(static_cast<size_t>(u * 10), size_t{9});
                counts[row * 10 + static_cast<size_t>((phi / pi_exact + 1) * 4.9999999)]++;
            }
            CHECK(chi_square_tail(chi_square(counts), 99) > 1e-6);
        }
    }

    TEST_CASE("density: spherical triangle") {
        for (auto [a, b, c] : {std::array<Vec3, 3>{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}},
                               {Vec3{-1, -1, 2}, Vec3{1, -1, 2}, Vec3{0, 1, 2}},
                               {Vec3{-1, -1, 0.05f}, Vec3{1, -1, 0.05f}, Vec3{0, 1, 0.05f}},
                               {Vec3{-0.1f, 0, 2}, Vec3{0.1f, 0, 2}, Vec3{0.02f, 0.05f, 2}},
                               {Vec3{-0.01f, 0, 2}, Vec3{0.01f, 0, 2}, Vec3{0.002f, 0.005f, 2}}}) {
            Vec3d p = unit(a), q = unit(b), r = unit(c);
            double omega = triangle_solid_angle(p, q, r);
            double chi2 = chi_square_of_triangle(a, b, c, [&](Vec2 u) {
                return to_vec3(sample_spherical_triangle(p, q, r, omega, u));
            });
            CHECK(chi_square_tail(chi2, 63) > 1e-6);
        }
    }

    TEST_CASE("consistency: the warps run backwards") {
        Sampler random = random_numbers(1);
        Vec3d a = unit({-1, -1, 2}), b = unit({1, -1, 1}), c = unit({0, 1, 2});
        double omega = triangle_solid_angle(a, b, c);
        CHECK(relative_error(pdf_spherical_triangle(omega) * omega, 1) < 1e-15);
        for (int i = 0; i < 1000; i++) {
            Vec2 u = {0.01f + 0.98f * random.u1(), 0.01f + 0.98f * random.u1()};
            Vec2 v = invert_cone(0.5f, sample_cone(0.5f, u));
            CHECK(std::abs(v.x - u.x) < 1e-5f);
            CHECK(std::abs(v.y - u.y) < 1e-5f);
            v = invert_spherical_triangle(a, b, c, omega,
                                          sample_spherical_triangle(a, b, c, omega, u));
            CHECK(std::abs(v.x - u.x) < 1e-6f);
            CHECK(std::abs(v.y - u.y) < 1e-6f);
        }
    }
}

TEST_SUITE("light shapes") {
    TEST_CASE("identity: rounding errors on a light are the same along each axis") {
        std::set<float> errors;
        for (const char* at : {"50 1 0", "0 50 1", "1 0 50", "-50 1 0", "0 1 -50"}) {
            Scene scene = world_of(std::string("AreaLightSource \"diffuse\" Translate ") + at +
                                   " Shape \"sphere\" \"float radius\" 10");
            errors.insert(emitter_of(scene, 0).eps);
        }
        CHECK(errors.size() == 1);
        CHECK(*errors.begin() == rounding_error(60));
    }

    TEST_CASE("identity: areas, and which two triangles make one piece") {
        std::vector<double> areas = {1, 4, pi_exact, pi_exact / 4};
        for (size_t i = 0; i < areas.size(); i++) {
            Scene scene = light_of(shapes[i].second);
            CHECK(relative_error(static_cast<double>(scene.light_shapes[0].area), areas[i]) < 1e-6);
            CHECK(pdf_area(scene, 0) * scene.light_shapes[0].area ==
                  doctest::Approx(1).epsilon(1e-6).scale(0));
        }
        CHECK(light_of(quad).light_shapes[0].parallelogram);
        CHECK(light_of(tilted_quad).light_shapes[0].parallelogram);
        CHECK_FALSE(light_of(kite).light_shapes[0].parallelogram);
        CHECK_FALSE(light_of(mesh).light_shapes[0].parallelogram);
    }

    TEST_CASE("density: points by area") {
        // 10 x 10 cells of the quad, and of the sphere (height and angle: Archimedes).
        Scene flat = light_of(quad), ball = light_of(sphere);
        std::array<double, 100> on_quad{}, on_ball{}, on_disk{};
        Scene round = light_of(disk);
        Sampler random = random_numbers(1);
        auto cell = [](float x, float y) {  // x, y in [0,1]
            return std::min(static_cast<size_t>(x * 10), size_t{9}) * 10 +
                   std::min(static_cast<size_t>(y * 10), size_t{9});
        };
        for (int i = 0; i < 100000; i++) {
            Vec2 u = random.u2();
            Vec3 p = sample_area(flat, 0, u).p;
            on_quad[cell(p.x + 0.5f, p.z + 0.5f)]++;
            p = 2 * (sample_area(ball, 0, u).p - Vec3{0, 1.5f, 0});
            on_ball[cell(p.y / 2 + 0.5f, std::atan2(p.z, p.x) / (2 * pi) + 0.5f)]++;
            p = 2 * (sample_area(round, 0, u).p - Vec3{0, 1, 0});
            on_disk[cell(p.x * p.x + p.z * p.z, std::atan2(p.z, p.x) / (2 * pi) + 0.5f)]++;
            CHECK(std::abs(p.y) < 1e-6f);
        }
        CHECK(chi_square_tail(chi_square(on_quad), 99) > 1e-6);
        CHECK(chi_square_tail(chi_square(on_ball), 99) > 1e-6);
        CHECK(chi_square_tail(chi_square(on_disk), 99) > 1e-6);
    }

    TEST_CASE("density: each triangle of a mesh gets samples in proportion to its area") {
        // Triangle k stands at x = k. One without area must not be chosen, not even by u = 0.
        std::string points, indices;
        const std::array<double, 5> areas = {0, 5, 0, 3, 2};
        for (int k = 0; k < 5; k++) {
            std::string x = std::to_string(k), s = std::to_string(areas[static_cast<size_t>(k)]);
            points += x + " 0 0  " + x + " 0 1  " + x + " " + s + " 0  ";
            for (int c = 0; c < 3; c++) indices += std::to_string(3 * k + c) + " ";
        }
        Scene scene = light_of("Shape \"trianglemesh\" \"integer indices\" [" + indices +
                               "] \"point3 P\" [" + points + "]");
        std::array<double, 5> counts{};
        Sampler random = random_numbers(1);
        for (int i = 0; i < 100000; i++) {
            Vec2 u = i == 0 ? Vec2{0, 0} : i == 1 ? Vec2{below_one, 0} : random.u2();
            Vec3 p = sample_area(scene, 0, u).p;
            REQUIRE(is_finite(p));
            counts[static_cast<size_t>(p.x + 0.5f)]++;
        }
        CHECK(counts[0] == 0);
        CHECK(counts[2] == 0);
        std::array<double, 3> found = {counts[1], counts[3], counts[4]};
        std::array<double, 3> expected = {5e4, 3e4, 2e4};
        CHECK(chi_square_tail(chi_square(found, expected), 2) > 1e-6);
    }

    TEST_CASE("consistency: a light's samples agree with its density") {
        for (const auto& [name_of, shape] : shapes) {
            const std::string& name = name_of;
            Scene scene = light_of(shape);
            for (Vec3 x : places) {
                Sampler random = random_numbers(1);
                int met = 0, wrong = 0;
                for (int i = 0; i < 2000; i++) {
                    LightPoint y = sample_solid_angle(scene, 0, x, random.u2());
                    REQUIRE(is_finite(y.p));
                    REQUIRE(std::isfinite(y.pdf));
                    if (y.pdf == 0) continue;
                    auto hit = intersect(scene, {x, normalize(y.p - x)});
                    if (!hit || off(hit->p, y.p) > 1e-3) continue;  // hidden by the light itself
                    met++;
                    double pdf = static_cast<double>(pdf_solid_angle(scene, 0, x, *hit));
                    wrong += relative_error(pdf, static_cast<double>(y.pdf)) > 1e-3;
                    CHECK(std::abs(std::abs(dot(hit->ng, y.n)) - 1) < 1e-3f);
                }
                CAPTURE(name);
                CHECK(wrong <=
                      10);  // on the edge of two triangles it may be the other one that is hit
                CHECK(met > 900);
            }
        }
    }

    TEST_CASE("truth: densities integrate to 1 over the light, or to the share that meets it") {
        for (const auto& [name_of, shape] : shapes) {
            const std::string& name = name_of;
            Scene scene = light_of(shape);
            for (Vec3 x : places) {
                Sampler random = random_numbers(1);
                RunningStats integral, met;
                for (int i = 0; i < 20000; i++) {
                    LightPoint y = sample_area(scene, 0, random.u2());
                    auto hit = intersect(scene, {x, normalize(y.p - x)});
                    bool seen = hit && off(hit->p, y.p) < 1e-3;
                    // integral pdf_w dw = integral pdf_w / (dA/dw) dA, one point at a time
                    double jacobian = static_cast<double>(area_to_solid_angle(1, x, y.p, y.n));
                    double area = static_cast<double>(scene.light_shapes[0].area);
                    integral.add(seen ? static_cast<double>(pdf_solid_angle(scene, 0, x, *hit)) *
                                            area / jacobian
                                      : 0);
                    LightPoint z = sample_solid_angle(scene, 0, x, random.u2());
                    auto at = intersect(scene, {x, normalize(z.p - x)});
                    met.add(z.pdf > 0 && at && off(at->p, z.p) < 1e-3 ? 1 : 0);
                }
                CAPTURE(name);
                double se = std::hypot(integral.standard_error(), met.standard_error());
                CHECK(std::abs(integral.mean() - met.mean()) <= 5 * se + 1e-3);
                CHECK(se < 0.05);
                if (name == "quad") CHECK(met.mean() == 1);
            }
        }
    }

    TEST_CASE("jacobian: area to solid angle") {
        // Solid angle of the unit square at distance 1: the mean of area / jacobian.
        Scene scene = light_of(quad);
        RunningStats omega;
        Sampler random = random_numbers(1);
        for (int i = 0; i < 100000; i++) {
            LightPoint y = sample_area(scene, 0, random.u2());
            omega.add(1 / static_cast<double>(area_to_solid_angle(y.pdf, {0, 0, 0}, y.p, y.n)));
        }
        CHECK(std::abs(omega.mean() - 0.8054316831613) < 5 * omega.standard_error());
        CHECK(omega.standard_error() < 1e-3);
        CHECK(area_to_solid_angle(1, {0, 0, 0}, {0, 0, 2}, {0, 0, -1}) == 4);
        CHECK(area_to_solid_angle(1, {0, 0, 0}, {2, 0, 0}, {0, 0, -1}) == 0);  // edge-on
    }
}

TEST_SUITE("light shapes irradiance") {
    TEST_CASE(
        "failure: on the light, in its plane, inside a ball: finite, and nothing from edge-on") {
        for (const auto& [name_of, shape] : shapes) {
            const std::string& name = name_of;
            Scene scene = light_of(shape);
            Vec3 on = sample_area(scene, 0, {0.3f, 0.4f}).p;
            Vec3 beside = on + Vec3{5, 0, 0};
            for (Vec3 x : {on, beside, scene.light_shapes[0].centre}) {
                Sampler random = random_numbers(1);
                for (int i = 0; i < 1000; i++) {
                    Vec2 u = i == 0   ? Vec2{0, 0}
                             : i == 1 ? Vec2{below_one, below_one}
                                      : random.u2();
                    LightPoint y = sample_solid_angle(scene, 0, x, u);
                    CAPTURE(name);
                    REQUIRE(std::isfinite(y.pdf));
                    REQUIRE(y.pdf >= 0);
                    if (y.pdf > 0) REQUIRE(is_finite(y.p));
                }
            }
        }
        Scene scene = light_of(quad);
        for (float x : {2.0f, 100.0f}) {
            CHECK(irradiance(scene, {x, 1, 0}, {0, 1, 0}, false, 1000).mean() == 0);
            CHECK(irradiance(scene, {x, 1, 0}, {-1, 0, 0}, false, 1000).mean() == 0);
        }
    }

    TEST_CASE("failure: a light without area gives no point") {
        Scene scene = light_of(quad);
        scene.geometry.positions.assign(scene.geometry.positions.size(), {0, 1, 0});
        prepare(scene, 1);
        CHECK(sample_area(scene, 0, {0.5f, 0.5f}).pdf == 0);
        CHECK(sample_solid_angle(scene, 0, {0, 0, 0}, {0.5f, 0.5f}).pdf == 0);
    }
}

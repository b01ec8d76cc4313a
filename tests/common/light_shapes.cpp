// Solid angles, and points drawn on lights of every shape.
#include "common/light/light_shapes.h"

#include <doctest/doctest.h>

#include <array>

#include "common/light/solid_angle.h"
#include "tests/support/gates.h"
#include "tests/support/scenes.h"

namespace {

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

/// How many of 1000 small squares of random numbers do not become an area of their own size over
/// the density: those across the border of two pieces, and all where sample and density disagree.
///
/// sample  (Vec2 u) -> a point or a unit direction, and its density; 0: no sample
template <class Sample>
int mismatches(const Sample& sample) {
    constexpr float h = 0x1p-10f;
    Sampler random = random_numbers(1);
    int wrong = 0;
    for (int i = 0; i < 1000; i++) {
        Vec2 u = random.u2();
        u = {0.02f + 0.96f * u.x, 0.02f + 0.96f * u.y};
        auto [left, pdf_left] = sample({u.x - h, u.y});
        auto [right, pdf_right] = sample({u.x + h, u.y});
        auto [below, pdf_below] = sample({u.x, u.y - h});
        auto [above, pdf_above] = sample({u.x, u.y + h});
        double pdf = sample(u).second;
        REQUIRE(std::isfinite(pdf));
        if (std::min({pdf, pdf_left, pdf_right, pdf_below, pdf_above}) == 0) continue;
        double area = length(cross(right - left, above - below)) / (4 * double{h} * double{h});
        wrong += !(std::abs(area * pdf - 1) < 0.02);
    }
    return wrong;
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

double off(Vec3 a, Vec3 b) { return static_cast<double>(length(a - b)); }

}  // namespace

TEST_SUITE("light shapes") {
    TEST_CASE("truth: solid angles of triangles and rectangles") {
        struct {
            double found, truth, error = 1e-12;
        } cases[] = {
            {triangle_angle({1, 0, 0}, {0, 1, 0}, {0, 0, 1}), pi_exact / 2},
            {triangle_angle({0, 0, 1}, {1, 0, 1}, {0, 1, 1}), 0.3398369094541},
            {triangle_angle({-1, -1, 2}, {1, -1, 2}, {0, 1, 2}), 0.4252343249688},
            {triangle_angle({0, 0, 1}, {1, 0, 1}, {1, 1e-3f, 1}), 0.000292893180108, 1e-7},
            // Around the viewer: half of all.
            {triangle_angle({1, 0, 0}, {0, 1, 0}, {-1, -1, 0}), 2 * pi_exact},
            {rectangle_angle(1, 1, 1), 0.8054316831613},
            {rectangle_angle(1, 1, 0.5f), 2.094395102393},  // 4 pi / 6
            {rectangle_angle(1, 1, 0.001f), 6.271871617537, 1e-9},
        };
        for (const auto& c : cases) CHECK(relative_error(c.found, c.truth) < c.error);
        CHECK(triangle_angle({1, 0, 0}, {2, 1, 0}, {1, 1, 0}) == 0);  // edge-on
    }

    TEST_CASE("density: directions in cones and triangles") {
        using Triangle = std::array<Vec3d, 3>;
        auto check = [&](const auto& sample, double pdf) {
            CHECK(mismatches([&](Vec2 u) { return std::pair(Vec3d(sample(u)), pdf); }) == 0);
        };
        for (float sin2 : {0.25f, 0.9999f})
            check([&](Vec2 u) { return sample_cone(sin2, u); }, double{pdf_cone(sin2)});
        for (const auto& [a, b, c] :
             {Triangle{unit({1, 0, 0}), unit({0, 1, 0}), unit({0, 0, 1})},
              {unit({-1, -1, 2}), unit({1, -1, 1}), unit({0, 1, 2})},
              {unit({-1, -1, 0.5f}), unit({1, -1, 0.5f}), unit({0, 1, 0.5f})},
              {unit({-0.1f, 0, 2}), unit({0.1f, 0, 2}), unit({0, 0.1f, 2})}}) {
            double omega = triangle_solid_angle(a, b, c);
            check([&, a = a, b = b,
                   c = c](Vec2 u) { return sample_spherical_triangle(a, b, c, omega, u); },
                  1 / omega);
        }
    }

    TEST_CASE("consistency: a light's samples agree with its density") {
        // Which integrates to 1, or to the share of directions that meet the light as aimed.
        for (const auto& [name_of, shape] : shapes) {
            const std::string& name = name_of;
            CAPTURE(name);
            Scene scene = light_of(shape);
            double area = static_cast<double>(scene.light_shapes[0].area);
            bool one_piece = name.ends_with("quad");
            CHECK(scene.light_shapes[0].parallelogram == one_piece);
            for (Vec3 x : places) {
                Sampler random = random_numbers(1);
                RunningStats integral, met;
                int wrong = 0;
                auto seen = [&](const LightPoint& y) {
                    auto hit = intersect(scene, {x, normalize(y.p - x)});
                    return hit && off(hit->p, y.p) < 1e-3 ? hit : std::nullopt;
                };
                for (int i = 0; i < 20000; i++) {
                    LightPoint y = sample_area(scene, 0, random.u2());
                    auto hit = seen(y);
                    // integral pdf_w dw = integral pdf_w / (dA/dw) dA, one point at a time
                    double jacobian = static_cast<double>(area_to_solid_angle(1, x, y.p, y.n));
                    integral.add(hit ? static_cast<double>(pdf_solid_angle(scene, 0, x, *hit)) *
                                           area / jacobian
                                     : 0);
                    LightPoint z = sample_solid_angle(scene, 0, x, random.u2());
                    REQUIRE(is_finite(z.p));
                    auto at = seen(z);
                    met.add(z.pdf > 0 && at ? 1 : 0);
                    if (z.pdf == 0 || !at) continue;
                    double pdf = static_cast<double>(pdf_solid_angle(scene, 0, x, *at));
                    wrong += relative_error(pdf, static_cast<double>(z.pdf)) > 1e-3;
                    wrong += std::abs(std::abs(dot(at->ng, z.n)) - 1) > 1e-3f;
                }
                CHECK(wrong <= 100);  // on the edge of two triangles the other one may be hit
                double se = std::hypot(integral.standard_error(), met.standard_error());
                CHECK(std::abs(integral.mean() - met.mean()) <= 5 * se + 1e-3);
                CHECK(se < 0.05);
                CHECK(met.mean() > 0.45);
                if (name == "quad") CHECK(met.mean() == 1);
            }
        }
    }

    TEST_CASE("failure: on the light and in its plane: finite; without area: no sample") {
        for (const auto& [name, shape] : shapes) {
            Scene scene = light_of(shape);
            Vec3 on = sample_area(scene, 0, {0.3f, 0.4f}).p;
            Sampler random = random_numbers(1);
            for (Vec3 x : {on, on + Vec3{5, 0, 0}, scene.light_shapes[0].centre})
                for (int i = 0; i < 1000; i++) {
                    LightPoint y = sample_solid_angle(scene, 0, x, random.u2());
                    REQUIRE((y.pdf == 0 || (y.pdf < infinity && is_finite(y.p))));
                }
        }
        Scene scene = light_of(quad);
        scene.geometry.positions.assign(scene.geometry.positions.size(), {0, 1, 0});
        prepare(scene, 1);
        CHECK(sample_area(scene, 0, {0.5f, 0.5f}).pdf == 0);
        CHECK(sample_solid_angle(scene, 0, {0, 0, 0}, {0.5f, 0.5f}).pdf == 0);
    }
}

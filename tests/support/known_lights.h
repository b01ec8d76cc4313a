// Lights whose effect is known, for the chapters that look for light in several ways (13 to 15).
#pragma once
#include <array>

#include "common/light/light_shapes.h"
#include "tests/support/estimators.h"

/// A lamp of this radiance; two_sided: "false" or "true".
inline std::string lamp(const std::string& L, const std::string& shape,
                        const std::string& reflectance, const std::string& two_sided = "false") {
    return "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [" + L + " " + L + " " + L +
           "] \"bool twosided\" " + two_sided + " Material \"diffuse\" \"rgb reflectance\" [" +
           reflectance + "]\n" + shape + "AttributeEnd\n";
}
inline std::string black_lamp(const std::string& L, const std::string& shape) {
    return lamp(L, shape, "0 0 0");
}

/// Chapter 12's target by a formula for each type of light, in double precision.
///
///   area:  p_hat = L A cos_x cos_y / d^2;  point:  L cos_x / d^2;  distant:  L cos_x;  sky:  pi L
inline double p_hat_by_type(const Scene& scene, size_t i, const Hit& x) {
    const Light& light = scene.lights[i];
    const LightShape& shape = scene.light_shapes[i];
    auto dot_of = [](Vec3 a, Vec3 b) {
        return double{a.x} * double{b.x} + double{a.y} * double{b.y} + double{a.z} * double{b.z};
    };
    double L = double{average(light.L)}, radius = double{shape.radius};
    if (light.type == LightType::infinite) return pi_exact * L;
    if (light.type == LightType::distant) return L * std::max(0.0, dot_of(light.p, x.n));
    Vec3 to_y = (light.type == LightType::area ? shape.centre : light.p) - x.p;
    double d = std::max(std::sqrt(dot_of(to_y, to_y)), radius), least = radius / d;
    double cos_x = dot_of(to_y, x.n) / d, cos_y = 1;
    if (light.type == LightType::point) return L * std::max(0.0, cos_x) / (d * d);
    if (shape.flat) cos_y = -dot_of(to_y, shape.first.n) / d;
    if (light.two_sided) cos_y = std::abs(cos_y);
    if (cos_x < -least || cos_y < -least) return 0;
    return L * double{shape.area} * std::max(least, cos_x) * std::max(least, cos_y) / (d * d);
}

/// Lights of every type above and below the origin, two of them two-sided.
inline Scene all_kinds() {
    return world_of(square(0, false) + "LightSource \"point\" \"point3 from\" [1 2 0]" +
                    "LightSource \"distant\" \"point3 to\" [1 -2 3] LightSource \"infinite\"\n" +
                    "AttributeBegin " + shining + "Translate 1 1 0 Shape \"sphere\" AttributeEnd " +
                    "AttributeBegin " + shining + "Rotate 70 1 2 3 Shape \"disk\" AttributeEnd " +
                    "AreaLightSource \"diffuse\" \"bool twosided\" true Translate 0 3 0 " +
                    square(0, false));
}

/// A point of a diffuse surface anywhere in the scene.
inline Hit somewhere(const Scene& scene, Sampler& random) {
    static const Material paint_all{};
    Hit x{};
    x.p = scene.radius * random.u1() * uniform_direction(random.u2());
    x.n = x.ng = uniform_direction(random.u2());
    x.material = &paint_all;
    return x;
}

/// A mirror ball of 0.9 that shows a light behind the camera; without noise by every way.
inline Scene light_before_mirror() {
    return world_of("Material \"conductor\" \"rgb reflectance\" [.9 .9 .9] Shape \"sphere\"\n" +
                    shining + "Translate 0 0 -9 Rotate -90 1 0 0 Scale 9 1 9 " + square(0, false));
}

/// Black lamps of the same size in a row, far above a floor; the radiance of number i is i + 1.
inline Scene ten_lamps() {
    std::string lamps = "Material \"diffuse\" \"rgb reflectance\" [0 0 0]\n";
    for (int i = 0; i < 10; i++)
        lamps += "AttributeBegin AreaLightSource \"diffuse\" \"float scale\" " +
                 std::to_string(i + 1) + " " + unit_square(9, 2 * i) + " AttributeEnd\n";
    return floor_under(lamps);
}
/// Each of the ten lamps is chosen as often as its pmf says, and has the density of its point times
/// this pmf. A sample's Le says whose it is.
template <class Sample>
void check_choice(const std::array<double, 10>& pmf, const Sample& sample) {
    Scene scene = ten_lamps();
    Hit x = origin_of(scene);
    std::array<double, 10> counts{}, expected{};
    for (size_t i = 0; i < 10; i++) expected[i] = 100000 * pmf[i];
    Sampler random = random_numbers(1);
    for (int i = 0; i < 100000; i++) {
        auto y = sample(scene, x, random);
        REQUIRE(y.pdf_w > 0);
        size_t light = static_cast<size_t>(std::lround(y.Le.g)) - 1;
        counts[light]++;
        if (i >= 100) continue;
        Hit hit = *intersect(scene, spawn_ray(x, y.wi));
        CHECK(hit.light == static_cast<int>(light));
        double pdf_one = static_cast<double>(pdf_solid_angle(scene, light, x.p, hit));
        CHECK(y.pdf_w == nearly(pmf[light] * pdf_one, 1e-4));
    }
    CHECK(chi_square_tail(chi_square(counts, expected), 9) > 1e-6);
}

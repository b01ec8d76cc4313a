// Chapter 18: dispersion.
#include <doctest/doctest.h>

#include "chapters/18_dispersion/estimator.h"
#include "common/base/error.h"
#include "common/material/spectrum.h"
#include "common/render/render.h"
#include "tests/support/estimators.h"

namespace {

Method by_eighteen(const Scene& scene) {
    return method_of<ch18::trace>(ch18::prepare(scene), shares_of_white());
}

}  // namespace

TEST_SUITE("ch18 dispersion") {
    TEST_CASE("identity: all wavelengths together are white") {
        std::vector<Rgb> white = shares_of_white();
        Rgb sum;
        constexpr int n = 1 << 16;
        double last = 0;
        for (int i = 0; i < n; i++) {
            auto drawn = ch18::sample_wavelength(white, (static_cast<float>(i) + 0.5f) / n);
            CHECK(average(drawn.weight) == nearly(1, 1e-5));
            CHECK(double{drawn.micrometres} >= last - 1e-6);
            last = double{drawn.micrometres};
            sum += drawn.weight / n;
        }
        for (float channel : {sum.r, sum.g, sum.b}) CHECK(std::abs(channel - 1) < 3e-4f);
        CHECK(last < 0.7851);
        CHECK(ch18::sample_wavelength(white, 0).micrometres > 0.37f);
        // Each interval is drawn by its share of white, evenly; its middle is the observer's
        // wavelength.
        double u = 0;
        for (size_t i = 0; i < white.size(); i++) {
            double p = double{average(white[i])}, part = i % 2 == 0 ? 0.5 : 0.25;
            auto drawn = ch18::sample_wavelength(white, static_cast<float>(u + part * p));
            u += p;
            if (p < 1e-3) continue;
            double at = static_cast<double>(i) - 0.5 + part;
            double nm = observer_first_nm + observer_step_nm * at;
            CHECK(1000 * double{drawn.micrometres} == nearly(nm, 1e-4));
            Rgb weight = white[i] / average(white[i]);
            for (float Rgb::*c : {&Rgb::r, &Rgb::g, &Rgb::b})
                CHECK(std::abs(drawn.weight.*c - weight.*c) < 1e-5f);
        }
    }

    TEST_CASE("truth: the glasses have the indices and Abbe numbers of their data sheets") {
        struct {
            const char* name;
            double n_d, abbe;
        } sheets[] = {{"glass-BAF10", 1.67003, 47.11}, {"glass-BK7", 1.516800034501, 64.1673362375},
                      {"glass-F10", 1.72828, 28.53},   {"glass-F11", 1.78472, 25.68},
                      {"glass-F5", 1.67270, 32.21},    {"glass-FK51A", 1.48656, 84.47},
                      {"glass-LASF9", 1.85025, 32.17}};
        REQUIRE(glasses().size() == std::size(sheets));
        for (const auto& [name, n_d, abbe] : sheets) {
            const Glass& glass = glasses().at(name);
            CAPTURE(name);
            double F = double{index_of_refraction(glass, 0.4861327)};
            double d = double{index_of_refraction(glass, 0.5875618)};
            double C = double{index_of_refraction(glass, 0.6562725)};
            CHECK(std::abs(d - n_d) < 2e-5);
            CHECK(std::abs((d - 1) / (F - C) - abbe) < 0.002 * abbe);
        }
    }

    TEST_CASE("truth: a prism of 60 degrees bends each color by its own angle") {
        struct {
            double micrometres, degrees;
        } cases[] = {
            {0.4861327, 39.14097361135}, {0.5875618, 38.65363675922}, {0.6562725, 38.43841179471}};
        for (auto [micrometres, degrees] : cases) {
            // The light comes through another glass before.
            ch18::Wavelength light = {static_cast<float>(micrometres), {}};
            Material materials[2];
            Hit x;
            for (size_t i : {0u, 1u}) {
                materials[i].glass = &glasses().at(i == 0 ? "glass-F11" : "glass-BK7");
                x.material = &materials[i];
                ch18::set_index(x, light);
            }
            float n = x.material->ior, rad = pi / 180;
            // Faces whose normals, towards the light and away from it, are 60 degrees apart.
            Vec3 in = {-std::cos(60 * rad / 2), std::sin(60 * rad / 2), 0};
            Vec3 out = {-in.x, in.y, 0};
            float a = std::atan2(in.y, in.x) + 50 * rad;  // towards the lamp, away from the edge
            Vec3 wo = {std::cos(a), std::sin(a), 0};
            Vec3 inside = *refract(wo, in, n);
            Vec3 after = *refract(-inside, -1 * out, 1 / n);
            double angle = std::acos(static_cast<double>(dot(after, -wo))) * 180 / pi_exact;
            CHECK(std::abs(angle - degrees) < 2e-4 * degrees);
        }
    }

    TEST_CASE("furnace: white in, white out, through glass with a name, color by color") {
        const Glass plain = {{1.25, 0, 0}, {0, 0, 0}};
        for (bool disperses : {false, true}) {
            Scene scene = scene_from("scenes/furnace-glass.pbrt", 16, 100);
            for (Material& m : scene.materials)
                if (m.type == MaterialType::dielectric)
                    m.glass = disperses ? &glasses().at("glass-F11") : &plain;
            Film film = film_of(scene, by_eighteen(scene), 512).film;
            Rgb mean = film.mean_rgb();
            // The variance of a channel is at most that of the weights, 1.4 to 1.7, where a path
            // meets the ball, which fills 0.395 of the picture, and 0 elsewhere.
            double se = std::sqrt(0.7 / static_cast<double>(film.samples()));
            for (float channel : {mean.r, mean.g, mean.b})
                CHECK(std::abs(double{channel} - 1) < 5 * se);
            CHECK(std::abs(film.mean() - 1) < 1e-4);
        }
    }
}

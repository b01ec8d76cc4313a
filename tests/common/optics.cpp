// Mirrors and glass: Fresnel's equations, slabs, balls and cubes of glass, and metals.
#include "common/material/optics.h"

#include <doctest/doctest.h>

#include <tuple>

#include "chapters/07_path_tracing/estimator.h"
#include "common/material/hit.h"
#include "common/material/spectrum.h"
#include "tests/support/directions.h"
#include "tests/support/estimators.h"
#include "tests/support/gates.h"

namespace {

double reflected(double degrees, double eta) {
    float cos = static_cast<float>(std::cos(degrees * std::numbers::pi / 180));
    return static_cast<double>(fresnel_dielectric(cos, static_cast<float>(eta)));
}

}  // namespace

TEST_SUITE("optics") {
    TEST_CASE("truth: Fresnel's equations for glass") {
        struct Row {
            double degrees, eta, R;
        };
        for (auto [degrees, eta, R] : {Row{0, 1.5, 0.04},
                                       {0, 2.417, 0.1719688325232},
                                       {30, 1.5, 0.04152262597582},
                                       {50, 1.5, 0.05766294470392},
                                       {56.30993247402, 1.5, 0.07396449704142},  // Brewster's angle
                                       {75, 1.5, 0.2530605629903},
                                       {89, 1.5, 0.9041849497802},
                                       {0, 1 / 1.5, 0.04},
                                       {30.7102207661, 1 / 1.5, 0.05766294470392},
                                       {40, 1 / 1.5, 0.2452912042869},
                                       {41.81, 1 / 1.5, 0.9798553651264}}) {
            // In float, cos_t loses digits as it goes to 0 (grazing, and the critical angle).
            double sin = std::sin(degrees * std::numbers::pi / 180) / eta;
            double cos_t = std::sqrt(1 - sin * sin);
            double angle = degrees;
            CAPTURE(angle);
            CHECK(std::abs(reflected(degrees, eta) - R) < 1e-6 / std::min(1.0, cos_t));
        }
        for (double degrees : {41.82, 45.0, 60.0, 89.9}) CHECK(reflected(degrees, 1 / 1.5) == 1);
        CHECK(fresnel_dielectric(0, 1.5f) == 1);
        CHECK(reflected(40, 1) == 0);
    }

    TEST_CASE("truth: inside glass, the sky is n^2 times as bright") {
        Scene scene = world_of(
            "LightSource \"infinite\" Material \"dielectric\" \"float eta\" 1.5 Shape \"sphere\"");
        scene.max_depth = 1000;
        RunningStats s = repeat(scene, {{0, 0, 0}, {0, 0, 1}}, ch07::trace, 1000);
        CHECK(s.mean() == nearly(2.25, 1e-5));
        CHECK(s.variance() < 1e-9);
    }

    TEST_CASE(
        "failure: 23.6 % of the directions in a glass cube never get out, yet all paths end") {
        Scene scene = world_of(
            "LightSource \"infinite\" Material \"dielectric\" \"float eta\" 1.5\n"
            "Shape \"trianglemesh\" \"integer indices\" [0 3 1 0 2 3 4 7 6 4 5 7 0 5 4 0 1 5"
            " 2 7 3 2 6 7 0 6 2 0 4 6 1 7 5 1 3 7]\n \"point3 P\" [-1 -1 -1  1 -1 -1"
            "  -1 1 -1  1 1 -1  -1 -1 1  1 -1 1  -1 1 1  1 1 1]");
        scene.max_depth = 100;
        constexpr int paths = 20000;
        constexpr float cos_critical = 0.7453559925f;
        Sampler random = random_numbers(1);
        RunningStats trapped;
        int disagreements = 0;
        for (int i = 0; i < paths; i++) {
            Vec3 d = uniform_direction(random.u2());
            float largest = max_component(abs(d));
            Recorder recorder;
            Rgb L = ch07::trace(scene, {{0.1f, 0.2f, 0.3f}, d}, random, recorder);
            trapped.add(recorder.paths_cut() > 0);
            // Away from the critical angle, whether a path gets out is no matter of chance: for
            // others, a hundred reflections at R < 1 are.
            if (largest < cos_critical - 1e-3f) disagreements += recorder.paths_cut() == 0;
            if (largest > cos_critical + 0.01f) disagreements += recorder.paths_cut() > 0;
            CHECK(is_finite(L));
        }
        CHECK(disagreements == 0);
        double p = std::sqrt(5.0) - 2;
        check_mean(trapped, p, p * (1 - p), 0.03);
    }

    TEST_CASE("identity: a metal's reflectance is Fresnel's with a complex index") {
        Sampler random = random_numbers(1);
        for (int i = 0; i < 10000; i++) {
            // Where metals lie: silver is 0.05 + 4 i, iron 2.9 + 3 i.
            float eta = 0.05f + 3 * random.u1(), k = i < 100 ? 0 : 1 + 4 * random.u1(),
                  cos_i = 1 - random.u1();
            double truth = RoughMetal{0, double{eta}, double{k}}.fresnel(double{cos_i});
            CAPTURE(eta);
            CAPTURE(k);
            CAPTURE(cos_i);
            CHECK(std::abs(double{fresnel_conductor(cos_i, eta, k)} - truth) < 2e-5);
        }
    }
}

namespace {

/// How far two colors are apart in the worst channel.
float apart(Rgb a, Rgb b) {
    return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
}

}  // namespace

TEST_SUITE("spectra") {
    TEST_CASE("truth: black bodies have the chromaticities that the CIE gives") {
        for (auto [kelvin, x, y] : {std::tuple(2855.542, 0.44757, 0.40745),  // illuminant A
                                    {6500, 0.3135, 0.3237}}) {
            Rgb c = blackbody_rgb(kelvin);
            double X = 0.4124 * c.r + 0.3576 * c.g + 0.1805 * c.b;
            double Y = 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b;
            double Z = 0.0193 * c.r + 0.1192 * c.g + 0.9505 * c.b;
            CHECK(std::abs(X / (X + Y + Z) - x) < 2e-4);
            CHECK(std::abs(Y / (X + Y + Z) - y) < 2e-4);
            CHECK(std::abs(Y - 1) < 1e-5);
        }
    }

    TEST_CASE("truth: the observer's columns have the sums and centres of the CIE's table") {
        const double sums[3] = {10.683642, 10.685779, 10.6769};
        const double centres[3] = {6108.62642, 5986.08563, 4848.0652};  // sums of nm times column
        for (size_t k = 0; k < 3; k++) {
            double sum = 0, centre = 0;
            for (size_t i = 0; i < observer.size(); i++) {
                sum += observer[i][k];
                centre += observer[i][k] * (380 + 10 * static_cast<double>(i));
            }
            CHECK(sum == nearly(sums[k], 1e-9));
            CHECK(centre == nearly(centres[k], 1e-9));
        }
    }

    TEST_CASE("truth: what metals reflect at normal incidence") {
        // By their measured eta and k, at the wavelengths of red, green and blue.
        for (const auto& [name, R] : {std::pair("Ag", Rgb{0.975f, 0.958f, 0.906f}),
                                      std::pair("Al", Rgb{0.928f, 0.918f, 0.919f}),
                                      std::pair("Au", Rgb{0.967f, 0.802f, 0.324f}),
                                      std::pair("Cu", Rgb{0.952f, 0.620f, 0.511f})}) {
            Rgb n = metals().at("metal-" + std::string(name) + "-eta"),
                k = metals().at("metal-" + std::string(name) + "-k");
            auto F = [](float eta, float kappa) {
                float square = kappa * kappa;
                return ((eta - 1) * (eta - 1) + square) / ((eta + 1) * (eta + 1) + square);
            };
            CHECK(apart(R, {F(n.r, k.r), F(n.g, k.g), F(n.b, k.b)}) < 2e-3f);
        }
    }
}

// Chapter 23: the radius in which photons count.
#include <doctest/doctest.h>

#include "chapters/23_photon_mapping/estimator.h"
#include "tests/support/light_paths.h"

TEST_SUITE("ch23 first radius") {
    /// Photons around each of 20,000 points, `n` within the radius 1: their flux is 1 + c d^2.
    std::vector<ch23::Photon> around_points(int n, float c, std::vector<ch23::SeenPoint>& points) {
        Sampler random(SamplerType::independent, 1, 1);
        std::vector<ch23::Photon> photons;
        for (int i = 0; i < 20000; i++) {
            Vec3 p = 10 * Vec3{static_cast<float>(i % 100), 0, static_cast<float>(i / 100)};
            points.push_back({p, {0, 1, 0}, 1 / pi, 1 / 6.0f});
            for (int j = 0; j < n; j++) {
                float d = std::sqrt(random.u1()), phi = 2 * pi * random.u1();
                float flux = (1 + c * d * d) / static_cast<float>(n);
                Vec3 at = p + d * Vec3{std::cos(phi), 0, std::sin(phi)};
                photons.push_back({at, {0, 1, 0}, {flux, flux, flux}});
            }
        }
        return photons;
    }

    /// The mean of d is that of e times c r^2 / 4 (c r^2 / 3 with the radius, c r^2 / 12 with
    /// half). The mean of e^2: integral of 4 (1 - q)^2 (1 + c r^2 q)^2 over q. Pairs of n photons:
    /// n (n - 1).
    double expected_ratio(int n, double c, double r) {
        double a = c * r * r, e2 = 4 * (1.0 / 3 + a / 6 + a * a / 30);
        return (n - 1) * r * r * a * a / 16 / e2;
    }

    TEST_CASE("truth: blur and variance of light that grows with the distance") {
        for (float c : {0.0f, 1.0f, 4.0f}) {
            for (int n : {3, 10}) {
                std::vector<ch23::SeenPoint> points;
                auto photons = around_points(n, c, points);
                double ratio = ch23::blur_to_noise(points, ch23::PhotonMap(photons, 1));
                CHECK(std::abs(ratio - expected_ratio(n, double{c}, 1)) < 0.1);
            }
        }
        // A point with the radiance L counts 1 / (L^2 + 0.01).
        std::vector<ch23::SeenPoint> points;
        auto photons = around_points(10, 4, points);
        double even = ch23::blur_to_noise(points, ch23::PhotonMap(photons, 1));
        for (size_t i = 0; i < photons.size() / 2; i++)
            photons[i].flux = 3.0f * photons[i].flux, points[i / 10].L = std::sqrt(0.08);
        CHECK(ch23::blur_to_noise(points, ch23::PhotonMap(photons, 1)) == nearly(even, 1e-3));
        CHECK(ch23::blur_to_noise({}, {}) == 0);
    }

    TEST_CASE("truth: the first radius is where light of a known profile blurs that much") {
        // Even light does not blur: six pixels. With c = 4 the ratio is above 1 at first.
        for (float c : {0.0f, 1.5f, 4.0f}) {
            std::vector<ch23::SeenPoint> points;
            auto photons = around_points(20, c, points);
            for (double share : {1.0, 0.5}) {
                double r = 1, ratio = expected_ratio(20, double{c}, r) / share;
                while (ratio > 1) {
                    r /= std::numbers::sqrt2;
                    ratio = expected_ratio(20, double{c}, r) / share;
                }
                r *= std::pow(0.04 / std::max(ratio, 0.04), 0.25);
                CHECK(double{ch23::first_radius(points, {}, photons, share)} == nearly(r, 0.05));
            }
        }
    }

    TEST_CASE("truth: the width of a pixel on a floor") {
        // A floor 1 m below a camera of 60 degrees. The median ray is 1.1 times as long as the
        // one in the middle. A picture with fewer than 128x128 pixels counts as one with as many.
        auto width_of = [](int pixels) {
            Scene scene = bulb_over_a_floor();
            scene.width = scene.height = pixels;
            return double{ch23::pixel_width(ch23::seen_points(scene))};
        };
        double width = 1.1 * 2 * std::tan(pi_exact / 6) / 128;
        CHECK(width_of(128) == nearly(width, 0.03));
        CHECK(width_of(32) == nearly(width_of(128), 1e-4));
        CHECK(width_of(256) == nearly(width_of(128) / 2, 1e-4));
    }

    TEST_CASE("identity: the first radius has the unit of the scene, whose size does not matter") {
        auto radius = [](float unit, const std::string& floor) {
            std::string u = std::to_string(unit) + " ", power = std::to_string(unit * unit) + " ";
            Scene scene = world_of(
                "Scale " + u + u + u +
                "AttributeBegin Material \"dielectric\" Translate 0 -.5 0 Shape \"sphere\" "
                "\"float radius\" 0.4 AttributeEnd LightSource \"point\" \"point3 from\" [1 2 0] "
                "\"rgb I\" [" +
                power + power + power + "] Translate 0 -1 0 Scale " + floor + square(0, true));
            scene.camera.o = unit * scene.camera.o;
            return double{ch23::photon_passes(scene, {}).first_radius} / double{unit};
        };
        double whole = radius(1, "30 1 30 ");
        CHECK(whole > 0.01);
        // A larger ground has a few more film points, so the search takes other steps.
        CHECK(radius(1, "3000 1 3000 ") == nearly(whole, 0.3));
        for (float unit : {0.001f, 1000.0f}) CHECK(radius(unit, "30 1 30 ") == nearly(whole, 0.01));
    }
}

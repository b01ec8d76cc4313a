// Chapter 07: path tracing: furnaces, closed enclosures, and paths that are cut.
#include <doctest/doctest.h>

#include "chapters/07_path_tracing/estimator.h"
#include "tests/support/directions.h"

namespace {

const Method trace_07 = method_of<ch07::trace>();

}  // namespace

TEST_SUITE("ch07 bsdf") {
    TEST_CASE("density: uniform hemisphere") {
        auto sample = [](Sampler& random) { return ch07::sample_uniform_hemisphere(random.u2()); };
        auto density = [](Vec3) { return ch07::pdf_uniform_hemisphere(); };
        CHECK(chance_of_directions({}, sample, density) > 1e-6);
        check_inverse(ch07::sample_uniform_hemisphere, ch07::invert_uniform_hemisphere, 1e-6f);
        for (float u : {0.0f, 0x1.fffffep-1f}) {
            Vec3 w = ch07::sample_uniform_hemisphere({u, u});
            CHECK(w.z > 0);
            CHECK(std::abs(length(w) - 1) < 1e-6f);
        }
    }
}

TEST_SUITE("ch07 path tracing") {
    TEST_CASE("truth: a diffuse ball in a white sky: mean a, variance a^2 / 3") {
        Scene scene = world_of("LightSource \"infinite\" Shape \"sphere\"");  // albedo 0.5
        RunningStats s = repeat(scene, {{0, 0, -4}, {0, 0, 1}}, trace_07, 400000);
        check_mean(s, 0.5, 0.25 / 3, 0.005);
        check_variance(s, 0.25 / 3, 1.8);  // evenly spread on [0, 2a]
    }

    TEST_CASE("furnace: every pixel of a convex diffuse ball is its albedo") {
        Scene scene = world_of(
            "LightSource \"infinite\" Material \"diffuse\" \"rgb reflectance\" [0.8 0.5 0.2]\n"
            "Shape \"sphere\"");
        Film film = film_of(scene, trace_07, 256).film;
        for (int i = 0; i < 32 * 32; i++) {
            const PixelSum& p = film.pixels()[static_cast<size_t>(i)];
            double from_middle = std::hypot(i % 32 - 15.5, i / 32 - 15.5);
            if (from_middle > 12.5) CHECK(p.mean() == 1);  // beside the ball there is sky
            if (from_middle > 10.5) continue;              // the ball's radius is 11.35 pixels
            for (auto [sum, a] : {std::pair{p.r(), 0.8}, {p.g(), 0.5}, {p.b(), 0.2}})
                CHECK(std::abs(sum / 256 - a) < 5 * a / std::sqrt(3 * 256));
        }
    }

    TEST_CASE("truth: closed sphere, cut off: every length of path brings a^k, no more, no less") {
        for (double a : {0.5, 0.8}) {
            constexpr int longest = 5;
            Census census = census_of(closed_sphere(a, longest), trace_07, 100000, 1);
            CHECK_FALSE(census.parts.contains("length 6"));
            for (size_t k = 0; k <= longest; k++) {
                double power = std::pow(a, k);
                Measured part = census.measured("length " + std::to_string(k));
                CAPTURE(k);
                CHECK(std::abs(part.mean - power) <= 5 * part.se + 1e-6);
                CHECK(part.se < 0.015 * power);
            }
            Measured all = census.measured("all");
            CHECK(std::abs(all.mean - (1 - std::pow(a, longest + 1)) / (1 - a)) < 5 * all.se);
        }
    }
}

// Chapter 09: explicit light sampling: known irradiances, near lights, what counts once.
#include <doctest/doctest.h>

#include "chapters/08_russian_roulette/estimator.h"
#include "chapters/09_light_sampling/estimator.h"
#include "tests/support/known_lights.h"

using ch09::LightMeasure;

namespace {

const Method trace_08 = method_of<ch08::trace>();
const Method trace_by_area = method_of<ch09::trace>(LightMeasure::area);
const Method trace_by_angle = method_of<ch09::trace>(LightMeasure::solid_angle);

ch09::LightSample light_sample(const Scene& scene, const Hit& x, Sampler& random) {
    float u1 = random.u1();
    return ch09::sample_light(scene, x, u1, random.u2(), LightMeasure::solid_angle);
}

}  // namespace

TEST_SUITE("ch09 light sampling") {
    TEST_CASE("truth: the factor that the light's cosine, area, albedo/pi and N make") {
        // Le cos_x / d^2, the mean over a unit light: 0.8054 and 0.2354; right, for albedo 1/2:
        // 0.5 E / pi. The slide is 6.73 and 6.41 times too bright.
        for (auto [h, E, factor] : {std::tuple{1.0, 0.7522746884541, 6.727165748426},
                                    {2.0, 0.2308367977302, 6.40820909353}}) {
            Scene scene = floor_under(shining + unit_square(h));
            RunningStats slide;
            Sampler random = random_numbers(1);
            for (int i = 0; i < 100000; i++) {
                Vec3 y = sample_area(scene, 0, random.u2()).p;
                slide.add(double{y.y / std::pow(length(y), 3.0f)});
            }
            check_bounded(slide, factor * 0.5 * E / pi_exact, 0.001);
        }
    }

    TEST_CASE("density: each of N lights is chosen equally often") {
        std::array<double, 10> tenths;
        tenths.fill(0.1);
        check_choice(tenths, light_sample);
    }

    TEST_CASE("truth: N equal lights give N times the light of one") {
        std::string lights;
        for (const char* turn : {"0", "90", "180", "270"})
            lights += "AttributeBegin " + shining + "Rotate " + turn + " 0 1 0 " +
                      unit_square(1, 1.5) + " AttributeEnd\n";
        check_bounded(irradiance(floor_under(lights), trace_by_angle, 100000), 4 * 0.1046370751909,
                      0.002);
    }
}

TEST_SUITE("ch09 near lights") {
    TEST_CASE("variance: near-light, a disk, by solid angle: below 1/3 at any height") {
        // R = 1: Omega of the bounding square over that of the disk, times 1 + the disk's own.
        for (auto [h, own] : {std::pair{1.0, 0.009812417174286},
                              {0.5, 0.04863267791677},
                              {0.1, 0.2235883582194},
                              {0.01, 0.3202633598833}}) {
            double square = 4 * std::atan(1 / (h * std::sqrt(2 + h * h)));
            double round = 2 * pi_exact * (1 - h / std::sqrt(1 + h * h));
            double relative = square / round * (1 + own) - 1, E = pi_exact / (1 + h * h);
            CHECK(relative < 1.0 / 3);
            Scene scene = floor_under(shining + disk(1, h));
            RunningStats s = irradiance(scene, trace_by_angle, 100000);
            check_mean(s, E, relative * E * E, 0.02 * E);
            check_variance(s, relative * E * E, 4);
        }
    }

    TEST_CASE("failure: in the light's plane, at a point light, and from infinitely far") {
        Scene level = floor_under(shining + "Translate 5 0 0 " + square(0, false));
        for (const Method& trace : {trace_by_area, trace_by_angle})
            CHECK(irradiance(level, trace, 1000).mean() == 0);
        Scene touching = floor_under("LightSource \"point\" \"point3 from\" [0 0 0]");
        Sampler random = random_numbers(1);
        CHECK(light_sample(touching, origin_of(touching), random).pdf_w == 0);
        for (std::string light : {"\"distant\" \"point3 from\" [0 1 0] \"point3 to\" [0 0 0]",
                                  "\"infinite\""}) {  // anything may be in between
            Scene far = floor_under("LightSource " + light);
            CHECK(light_sample(far, origin_of(far), random).dist == infinity);
        }
    }
}

TEST_SUITE("ch09 pictures") {
    TEST_CASE(
        "failure: nobody samples a light in glass: all its light comes by LSS, found by chance") {
        Scene scene = scene_from("scenes/light-in-glass.pbrt", 32, 8);
        Census census = census_of(scene, trace_by_angle, 40000, 1, {"LSS.*E"});
        CHECK(census.parts["all"].sum == nearly(census.parts["all LSS.*E"].sum, 1e-5));
        CHECK(census.parts["all"].sum > 0);
        CHECK(rel_mse(scene, trace_by_angle, 64) == nearly(rel_mse(scene, trace_08, 64), 0.2));
    }

    TEST_CASE("variance: on the Cornell box, a twentieth of the variance of chapter 08") {
        Scene scene = scene_from("scenes/cornell.pbrt", 32, 8);
        CHECK(rel_mse(scene, trace_by_angle, 128) < rel_mse(scene, trace_08, 512) / 20);
    }
}

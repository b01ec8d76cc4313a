// Chapter 10: cosine sampling: the warp, samples that are all alike, and a sky where it is worse.
#include <doctest/doctest.h>

#include "chapters/09_light_sampling/estimator.h"
#include "chapters/10_cosine_sampling/estimator.h"
#include "tests/support/directions.h"

TEST_SUITE("ch10 cosine sampling") {
    TEST_CASE("density: cosine hemisphere") {
        auto sample = [](Sampler& random) { return ch10::sample_cosine_hemisphere(random.u2()); };
        auto density = [](Vec3 w) { return ch10::pdf_cosine_hemisphere(w.z); };
        CHECK(chance_of_directions({}, sample, density) > 1e-6);
        check_inverse(ch10::sample_cosine_hemisphere, ch10::invert_cosine_hemisphere, 1e-6f);
        for (float u : {0.0f, 0.3f, 0x1.fffffep-1f})
            CHECK(length(ch10::sample_cosine_hemisphere({u, 1 - u})) == nearly(1));
    }

    TEST_CASE("identity: f cos / pdf_w is the albedo, whatever is drawn") {
        constexpr float below_one = 0x1.fffffep-1f;
        const Material diffuse{MaterialType::diffuse, 0, {0.5f, 0.25f, 0.75f}, {}, {}};
        Sampler random = random_numbers(1);
        Scene under_sky;
        under_sky.lights.emplace_back().type = LightType::infinite;
        for (int i = 0; i < 10000; i++) {
            Hit x{};
            x.n = x.ng = uniform_direction(random.u2());
            x.material = &diffuse;
            Vec2 u = i < 2 ? Vec2{i == 0 ? 0 : below_one, 0} : random.u2();
            BsdfSample s = ch10::sample_bsdf(x, x.n, random.u1(), u);
            if (s.pdf_w == 0) continue;  // the horizon, by rounding
            float cos = dot(s.wi, x.n);
            double rounding = 1e-5 + 5e-7 / double{cos};  // of the cosine
            Rgb weight = s.f * (cos / s.pdf_w);
            CHECK(weight.r == nearly(0.5, rounding));
            CHECK(weight.g == nearly(0.25, rounding));
            CHECK(weight.b == nearly(0.75, rounding));
            CHECK(ch10::pdf_bsdf(x, x.n, s.wi) == nearly(s.pdf_w, rounding));
            CHECK(ch10::eval_bsdf(x, x.n, s.wi).g == nearly(s.f.g));

            // So are directions to a sky, around the shading normal.
            x.ng = uniform_direction(random.u2());
            auto y = ch10::sample_one_light(under_sky, 0, x, random.u2());
            cos = dot(y.wi, x.n);
            CHECK(cos / y.pdf_w == nearly(pi_exact, 1e-5 + 5e-7 / double{cos}));
        }
    }

    TEST_CASE("failure: under horizon-sky.pbrt chapter 10 is worse than 09, with the same mean") {
        Scene scene = scene_from("scenes/horizon-sky.pbrt", 32, 8);
        Method trace_09 = method_of<ch09::trace>(ch09::LightMeasure::solid_angle);
        Film before = film_of(scene, trace_09, 256).film;
        Film now = film_of(scene, method_of<ch10::trace>(), 512, 2).film;
        CHECK(rel_mse(now) > 3 * rel_mse(before));
        check_agreement(hold_against(now, before), 0.02);
    }
}

// No claim of a reader's own file.
TEST_SUITE("slides of chapter 10") {
    TEST_CASE("truth: mixed-up densities make an albedo 4 pi, 2 pi, 2 times as large") {
        // "PDF = dot / (2 pi), BRDF = 2 color dot": without noise, so it looks right.
        Sampler random = random_numbers(1);
        for (int i = 0; i < 1000; i++) {
            float dot = ch10::sample_cosine_hemisphere(random.u2()).z;
            float pdf = ch10::pdf_cosine_hemisphere(dot), slide = dot / (2 * pi), f_cos = dot / pi;
            CHECK(2 * dot / slide == nearly(12.56637061436));
            CHECK(2 * dot / pdf == nearly(6.28318530718));
            CHECK(f_cos / slide == nearly(2));
            CHECK(f_cos / pdf == nearly(1));
        }
    }
}

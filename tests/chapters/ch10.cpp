// Chapter 10: cosine sampling: the warp, samples that are all alike, and a sky where it is worse.
#include <doctest/doctest.h>

#include <array>

#include "chapters/09_light_sampling/estimator.h"
#include "chapters/10_cosine_sampling/estimator.h"
#include "tests/support/estimators.h"

namespace {

/// Chapter 09 as it is without options.
const Method trace_09 = method_of<ch09::trace>(ch09::LightMeasure::solid_angle);

constexpr float below_one = 0x1.fffffep-1f;

Hit facing(Vec3 n) {
    static const Material diffuse{MaterialType::diffuse, 0, {0.5f, 0.25f, 0.75f}, {}, {}};
    Hit x{};
    x.n = x.ng = n;
    x.material = &diffuse;
    return x;
}

}  // namespace

TEST_SUITE("ch10 cosine sampling") {
    TEST_CASE("density: cosine hemisphere") {
        std::array<double, 100> counts{};
        RunningStats z, z2, x2;
        Sampler random = random_numbers(1);
        for (int i = 0; i < 100000; i++) {
            Vec3 w = ch10::sample_cosine_hemisphere(random.u2());
            double cos = static_cast<double>(w.z), x = static_cast<double>(w.x);
            // Equally likely cells: 10 steps of the chance z^2 to lie lower, times 10 of phi.
            double phi = std::atan2(static_cast<double>(w.y), x) + pi_exact;
            auto cell = [](double share) { return std::min(9, static_cast<int>(10 * share)); };
            counts[static_cast<size_t>(10 * cell(cos * cos) + cell(phi / (2 * pi_exact)))]++;
            z.add(cos), z2.add(cos * cos), x2.add(x * x);
        }
        CHECK(chi_square_tail(chi_square(counts), 99) > 1e-6);
        check_mean(z, 2.0 / 3, 1.0 / 18, 0.006);
        check_mean(z2, 0.5, 1.0 / 12, 0.008);
        check_mean(x2, 0.25, 0.125 - 0.0625, 0.007);  // E x^4 = E r^4 E cos^4 = 3/8 / 3
    }

    TEST_CASE("consistency: invert_cosine_hemisphere finds the numbers of a sample") {
        Sampler random = random_numbers(1);
        for (int i = 0; i < 1000; i++) {
            Vec2 u = random.u2(),
                 v = ch10::invert_cosine_hemisphere(ch10::sample_cosine_hemisphere(u));
            CHECK(std::abs(u.x - v.x) < 1e-6f);
            CHECK((v.y >= 0 && v.y <= 1));
            CHECK(std::abs(std::remainder(u.y - v.y, 1.0f)) * std::sqrt(u.x) < 1e-6f);
        }
    }

    TEST_CASE("identity: f cos / pdf_w is the albedo, whatever is drawn") {
        Sampler random = random_numbers(1);
        for (int i = 0; i < 10000; i++) {
            Hit x = facing(uniform_direction(random.u2()));
            Vec2 u = i < 2 ? Vec2{i == 0 ? 0 : below_one, 0} : random.u2();
            BsdfSample s = ch10::sample_bsdf(x, x.n, random.u1(), u);
            if (s.pdf_w == 0) continue;  // the horizon, by rounding
            Rgb weight = s.f * (dot(s.wi, x.n) / s.pdf_w);
            CHECK(weight.r == doctest::Approx(0.5).epsilon(1e-5).scale(0));
            CHECK(weight.g == doctest::Approx(0.25).epsilon(1e-5).scale(0));
            CHECK(weight.b == doctest::Approx(0.75).epsilon(1e-5).scale(0));
            CHECK(ch10::pdf_bsdf(x, x.n, s.wi) == s.pdf_w);
            CHECK(ch10::eval_bsdf(x, x.n, s.wi) == s.f);
        }
    }

    TEST_CASE("truth: what the slides' densities make of an albedo: 4 pi, 2 pi, 2 times as much") {
        // "PDF = dot / (2 pi), BRDF = 2 color dot": without noise, so it looks right.
        struct Row {
            std::string variant;
            double factor;
            double (*weight)(double);
        };
        for (auto [variant, factor, weight] :
             {Row{"as printed", 12.56637061436,
                  [](double dot) { return 2 * dot / (dot / (2 * pi_exact)); }},
              {"pdf repaired", 6.28318530718,
               [](double dot) { return 2 * dot / (dot / pi_exact); }},
              {"BRDF repaired", 2,
               [](double dot) { return dot / pi_exact / (dot / (2 * pi_exact)); }},
              {"right", 1, [](double dot) { return dot / pi_exact / (dot / pi_exact); }}}) {
            RunningStats s;
            Sampler random = random_numbers(1);
            for (int i = 0; i < 1000; i++)
                s.add(weight(double{ch10::sample_cosine_hemisphere(random.u2()).z}));
            CHECK(s.mean() == doctest::Approx(factor).epsilon(1e-9).scale(0));
            CHECK(s.variance() < 1e-20);
        }
    }

    TEST_CASE("failure: under horizon-sky.pbrt chapter 10 is worse than 09, with the same mean") {
        Scene scene = scene_from("scenes/horizon-sky.pbrt", 32, 8);
        Film before = film_of(scene, trace_09, 256).film;
        Film now = film_of(scene, ch10::trace, 512, 2).film;
        CHECK(rel_mse(now) > 3 * rel_mse(before));
        check_agreement(hold_against(now, before), 0.02);
    }

    TEST_CASE("agreement: pictures, lengths and classes of paths with chapter 09" *
              doctest::skip()) {
        for (const auto& [name, least] :
             std::vector<std::pair<std::string, int>>{{"cornell", 6},
                                                      {"cornell-spheres", 8},
                                                      {"color-bleeding", 6},
                                                      {"near-light", 2},
                                                      {"two-lights", 4},
                                                      {"light-in-glass", 4},
                                                      {"horizon-sky", 2},
                                                      {"hidden-light", 6}}) {
            Scene scene = scene_from("scenes/" + name + ".pbrt", 32, 8);
            CHECK(check_classes(scene, trace_09, scene, ch10::trace, 40000) >= least);
        }
        Scene scene = scene_from("scenes/cornell.pbrt", 32, 8);
        check_agreement(hold_against(film_of(scene, trace_09, 192).film,
                                     film_of(scene, ch10::trace, 192, 2).film),
                        0.01);
    }
}

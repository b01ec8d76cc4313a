// Chapter 13: rough metal, and the two ways to look for light on it, each of which fails somewhere.
#include <doctest/doctest.h>

#include "chapters/13_glossy/estimator.h"
#include "tests/support/directions.h"
#include "tests/support/plates.h"

using ch13::Strategy;

namespace {

/// The chapter's trace by this way of looking for light.
Method by(Strategy strategy, const Scene& scene) {
    return method_of<ch13::trace>(ch13::prepare(scene), strategy);
}

/// A point of rough metal, by default one that reflects nearly all; z is its normal.
struct Metal {
    Material material;
    Hit x = {};

    explicit Metal(float alpha, float eta = 1, float k = 1e4f) {
        material.type = MaterialType::conductor;
        material.eta = {eta, eta, eta}, material.k = {k, k, k}, material.alpha = alpha;
        x.n = x.ng = {0, 0, 1};
        x.material = &material;
    }
    Metal(const Metal&) = delete;
};
Vec3 at(double degrees) {
    double a = degrees * pi_exact / 180;
    return {static_cast<float>(std::sin(a)), 0, static_cast<float>(std::cos(a))};
}
/// f cos / pdf of a sample.
float weight_of(const BsdfSample& s) { return s.pdf_w == 0 ? 0 : s.f.g * s.wi.z / s.pdf_w; }

/// The chance of normals that are seen from wo, if drawn as seen from `drawn_from`.
double chance_of_normals(float alpha, Vec3 wo, Vec3 drawn_from) {
    return chance_of_directions(
        {double{alpha}},
        [&](Sampler& random) { return ch13::sample_ggx_normal(drawn_from, alpha, random.u2()); },
        [&](Vec3 h) { return ch13::pdf_ggx_normal(wo, alpha, h); });
}

}  // namespace

TEST_SUITE("ch13 rough metal") {
    TEST_CASE("density: GGX normals") {
        for (float alpha : {0.001f, 0.02f, 0.2f, 1.0f})
            for (double degrees : {0.0, 30.0, 85.0}) {
                CAPTURE(alpha);
                CAPTURE(degrees);
                CHECK(chance_of_normals(alpha, at(degrees), at(degrees)) > 1e-6);
            }
    }

    TEST_CASE("teeth: normals of all facets fail the test of those that are seen") {
        CHECK(chance_of_normals(0.2f, at(60), at(0)) < 1e-6);
    }

    TEST_CASE("density: directions of rough metal, from their half vectors") {
        for (float alpha : {0.05f, 0.4f, 1.0f})
            for (double degrees : {0.0, 50.0, 80.0}) {
                CAPTURE(alpha);
                CAPTURE(degrees);
                Metal metal(alpha);
                Vec3 wo = at(degrees);
                auto half_vector = [&](Sampler& random) {
                    float u1 = random.u1();
                    BsdfSample s = ch13::sample_bsdf(metal.x, wo, u1, random.u2());
                    return s.pdf_w == 0 ? Vec3{} : normalize(wo + s.wi);  // 0: under the surface
                };
                auto density = [&](Vec3 h) {  // d wi = 4 (wo.h) d h
                    float stretch = 4 * std::max(0.0f, dot(wo, h));
                    return ch13::pdf_bsdf(metal.x, wo, reflect(wo, h)) * stretch;
                };
                CHECK(chance_of_directions({double{alpha}}, half_vector, density) > 1e-6);
            }
    }

    TEST_CASE("consistency: invert_ggx_normal finds the numbers of a sample") {
        for (float alpha : {0.05f, 0.3f, 1.0f})
            for (double degrees : {0.0, 50.0, 85.0}) {
                Vec3 wo = at(degrees);
                check_inverse([&](Vec2 u) { return ch13::sample_ggx_normal(wo, alpha, u); },
                              [&](Vec3 h) { return ch13::invert_ggx_normal(wo, alpha, h); }, 2e-4f);
            }
    }

    TEST_CASE(
        "truth: the share of a white sky that rough metal reflects, by quadrature in double") {
        CHECK(RoughMetal{0.5, 0.2, 3.9}.albedo(pi_exact / 3) == nearly(0.66274, 1e-5));
        for (auto [alpha, eta, k] : {std::tuple{0.005, 1.0, 1e4},
                                     {0.1, 0.2, 3.9},
                                     {0.5, 0.2, 3.9},
                                     {1.0, 1.0, 1e4},
                                     {1.0, 1.5, 2.0}}) {
            Metal metal(static_cast<float>(alpha), static_cast<float>(eta), static_cast<float>(k));
            for (double degrees : {0.0, 45.0, 60.0, 80.0}) {
                CAPTURE(alpha);
                CAPTURE(degrees);
                double truth = RoughMetal{alpha, eta, k}.albedo(degrees * pi_exact / 180, 0, 400);
                if (alpha < 0.01) CHECK(truth > 0.999);  // smooth: all
                Vec3 wo = at(degrees);
                // By the metal's own samples, and by even ones, which know nothing of its density.
                RunningStats own, even;
                Sampler random = random_numbers(1);
                for (int i = 0; i < 40000; i++) {
                    float u1 = random.u1();
                    own.add(double{weight_of(ch13::sample_bsdf(metal.x, wo, u1, random.u2()))});
                    Vec3 wi = sample_uniform_hemisphere(random.u2());
                    even.add(double{ch13::eval_bsdf(metal.x, wo, wi).g * wi.z * 2 * pi});
                }
                CHECK(std::abs(own.mean() - truth) < 5 * own.standard_error() + 2e-4);
                CHECK(own.standard_error() < 0.004);
                if (alpha < 0.5) continue;  // too narrow for even samples
                CHECK(std::abs(even.mean() - truth) < 5 * even.standard_error() + 2e-4);
                CHECK(even.standard_error() < 0.03);
            }
        }
    }
}

TEST_SUITE("ch13 glossy") {
    TEST_CASE(
        "agreement: both ways on each plate with each lamp, and the page's table of variances" *
        doctest::skip()) {
        // Plates from smooth to rough, lamps from large to small.
        constexpr double by_bsdf[4][4] = {{0.00056, 0.0053, 0.048, 0.44},
                                          {0.017, 0.155, 1.36, 12},
                                          {0.178, 1.51, 13, 119},
                                          {1.05, 8.8, 78, 713}};
        constexpr double by_aim[4][4] = {{620, 64, 6.9, 0.57},
                                         {20, 2.0, 0.129, 0.0030},
                                         {1.83, 0.12, 0.0029, 0.00004},
                                         {0.221, 0.0069, 0.00010, 0.0000013}};
        for (size_t plate = 0; plate < 4; plate++)
            for (size_t lamp = 0; lamp < 4; lamp++) {
                CAPTURE(plate);
                CAPTURE(lamp);
                PlateAndLamp view(plate, lamp);
                RunningStats a = view.sample(by(Strategy::light, view.scene), 100000, 1);
                RunningStats b = view.sample(by(Strategy::bsdf, view.scene), 100000, 2);
                CHECK(z_between(measured(a), measured(b)) < 5);
                CHECK(std::hypot(a.standard_error(), b.standard_error()) < 0.1 * a.mean());
                CHECK(std::abs(std::log(relative_variance(a) / by_aim[plate][lamp])) < 0.5);
                CHECK(std::abs(std::log(relative_variance(b) / by_bsdf[plate][lamp])) < 0.5);
            }
    }
}

// Chapter 13: rough metal, and the two ways to look for light on it, each of which fails somewhere.
#include <doctest/doctest.h>

#include <array>

#include "chapters/11_light_importance/estimator.h"
#include "chapters/13_glossy/estimator.h"
#include "common/base/error.h"
#include "tests/support/ggx_truth.h"
#include "tests/support/known_lights.h"
#include "tests/support/plates.h"

using ch13::Strategy;

namespace {

/// The chapter's trace by this way of looking for light.
Method by(Strategy strategy, const Scene& scene) {
    return method_of<ch13::trace>(ch13::prepare(scene), strategy);
}

/// A point of rough metal of this roughness that reflects (nearly) all; z is its normal.
Hit metal(const Material& material) {
    Hit x{};
    x.n = x.ng = {0, 0, 1};
    x.material = &material;
    return x;
}
Material rough(float alpha, float k = 1e4f) {
    Material m;
    m.type = MaterialType::conductor;
    m.eta = {1, 1, 1};
    m.k = {k, k, k};
    m.alpha = alpha;
    return m;
}
Vec3 at(double degrees) {
    double a = degrees * pi_exact / 180;
    return {static_cast<float>(std::sin(a)), 0, static_cast<float>(std::cos(a))};
}

/// Normals of microfacets in cells of a table: v = 1 - sqrt(1 - s), s = tan^2 / (alpha^2 + tan^2),
/// and phi. Under D cos all s are equally likely; v has more cells where facets are steep.
struct NormalCells {
    static constexpr int n = 10;
    double alpha;

    size_t of(Vec3 h) const {
        double t2 = static_cast<double>(h.x * h.x + h.y * h.y) / static_cast<double>(h.z * h.z);
        double s = t2 / (alpha * alpha + t2), phi = std::atan2(double{h.y}, double{h.x}) / 2;
        int i = std::min(n - 1, static_cast<int>(n * (1 - std::sqrt(1 - s))));
        int j = std::clamp(static_cast<int>(n * (phi / pi_exact + 0.5)), 0, n - 1);
        return static_cast<size_t>(n * i + j);
    }
    /// Sums g(h) d omega over each cell, from fine^2 points in it.
    template <class Function>
    std::vector<double> integrate(const Function& g, int fine = 40) const {
        std::vector<double> sums(n * n);
        int m = n * fine;
        for (int i = 0; i < m; i++) {
            double v = (i + 0.5) / m, s = 1 - (1 - v) * (1 - v);
            double z = 1 / std::sqrt(1 + alpha * alpha * s / (1 - s)), r = std::sqrt(1 - z * z);
            double dz_dv = z * z * z * alpha * alpha / ((1 - s) * (1 - v));
            for (int j = 0; j < m; j++) {
                double phi = 2 * pi_exact * ((j + 0.5) / m - 0.5);
                Vec3 h = {static_cast<float>(r * std::cos(phi)),
                          static_cast<float>(r * std::sin(phi)), static_cast<float>(z)};
                sums[static_cast<size_t>(n * (i / fine) + j / fine)] +=
                    g(h) * dz_dv * 2 * pi_exact / m / m;
            }
        }
        return sums;
    }
};

double sum_of(const std::vector<double>& cells) {
    double sum = 0;
    for (double x : cells) sum += x;
    return sum;
}

/// chi^2 of counts against expected ones, with cells of less than 10 put together: the chance that
/// it is larger.
double chi_square_chance(const std::vector<double>& counts, const std::vector<double>& expected) {
    std::vector<double> c{0}, e{0};
    for (size_t i = 0; i < counts.size(); i++) {
        if (expected[i] < 10) {
            c[0] += counts[i], e[0] += expected[i];
        } else {
            c.push_back(counts[i]), e.push_back(expected[i]);
        }
    }
    if (e[0] < 10) c[0] = e[0] = 1;  // too few to say anything
    return chi_square_tail(chi_square(c, e), static_cast<int>(c.size()) - 1);
}

}  // namespace

TEST_SUITE("ch13 rough metal") {
    TEST_CASE("density: GGX normals") {
        for (float alpha : {0.02f, 0.2f, 1.0f})
            for (double degrees : {0.0, 30.0, 85.0}) {
                CAPTURE(alpha);
                CAPTURE(degrees);
                NormalCells cells{static_cast<double>(alpha)};
                Vec3 wo = at(degrees);
                std::vector<double> counts(100), expected = cells.integrate([&](Vec3 h) {
                    return 50000 * static_cast<double>(ch13::pdf_ggx_normal(wo, alpha, h));
                });
                Sampler random = random_numbers(1);
                for (int i = 0; i < 50000; i++)
                    counts[cells.of(ch13::sample_ggx_normal(wo, alpha, random.u2()))]++;
                CHECK(chi_square_chance(counts, expected) > 1e-6);
            }
    }

    TEST_CASE("teeth: normals of all facets fail the test of those that are seen") {
        NormalCells cells{0.2};
        Vec3 wo = at(60);
        std::vector<double> counts(100), expected = cells.integrate([&](Vec3 h) {
            return 50000 * static_cast<double>(ch13::pdf_ggx_normal(wo, 0.2f, h));
        });
        Sampler random = random_numbers(1);
        for (int i = 0; i < 50000; i++)  // as seen from straight above
            counts[cells.of(ch13::sample_ggx_normal({0, 0, 1}, 0.2f, random.u2()))]++;
        CHECK(chi_square_chance(counts, expected) < 1e-6);
    }

    TEST_CASE("density: directions of rough metal, from their half vectors") {
        for (float alpha : {0.05f, 0.4f, 1.0f})
            for (double degrees : {0.0, 50.0, 80.0}) {
                CAPTURE(alpha);
                CAPTURE(degrees);
                Material material = rough(alpha);
                Hit x = metal(material);
                NormalCells cells{static_cast<double>(alpha)};
                Frame frame(x.n);
                Vec3 wo = frame.to_world(at(degrees));
                // d wi = 4 (wo.h) d h
                std::vector<double> counts(100), expected = cells.integrate([&](Vec3 h) {
                    Vec3 n = frame.to_world(h), wi = reflect(wo, n);
                    float stretch = 4 * std::max(0.0f, dot(wo, n));
                    return 50000 * static_cast<double>(ch13::pdf_bsdf(x, wo, wi) * stretch);
                });
                Sampler random = random_numbers(1);
                for (int i = 0; i < 50000; i++) {
                    BsdfSample s = ch13::sample_bsdf(x, wo, random.u1(), random.u2());
                    if (s.pdf_w == 0) continue;  // under the surface
                    counts[cells.of(normalize(frame.to_local(wo) + frame.to_local(s.wi)))]++;
                }
                CHECK(chi_square_chance(counts, expected) > 1e-6);
                CHECK(std::abs(sum_of(counts) - sum_of(expected)) < 5 * std::sqrt(50000 * 0.25));
            }
    }

    TEST_CASE("consistency: invert_ggx_normal finds the numbers of a sample") {
        Sampler random = random_numbers(1);
        for (int i = 0; i < 1000; i++) {
            float alpha = 0.05f + 0.95f * random.u1();
            Vec3 wo = at(85 * double{random.u1()});
            Vec2 u = random.u2();
            Vec2 v = ch13::invert_ggx_normal(wo, alpha, ch13::sample_ggx_normal(wo, alpha, u));
            CHECK(std::abs(u.x - v.x) < 2e-4f);
            CHECK((v.y >= 0 && v.y <= 1));
            CHECK(std::abs(std::remainder(u.y - v.y, 1.0f)) * std::min(u.x, 1 - u.x) < 2e-4f);
        }
    }

    TEST_CASE("consistency: samples, values and densities agree; f is the same both ways round") {
        Sampler random = random_numbers(1);
        for (int i = 0; i < 5000; i++) {
            Material material = rough(0.01f + 0.99f * random.u1(), 3);
            Hit x = metal(material);
            Vec3 wo = at(89 * double{random.u1()});
            BsdfSample s = ch13::sample_bsdf(x, wo, random.u1(), random.u2());
            CHECK(!s.specular);
            if (s.pdf_w == 0) continue;
            CHECK(std::isfinite(s.pdf_w));
            CHECK(is_finite(s.f));
            CHECK(length(s.wi) == doctest::Approx(1).epsilon(1e-5).scale(0));
            CHECK(ch13::pdf_bsdf(x, wo, s.wi) == s.pdf_w);
            CHECK(ch13::eval_bsdf(x, wo, s.wi) == s.f);
            CHECK(ch13::eval_bsdf(x, s.wi, wo).g ==
                  doctest::Approx(double{s.f.g}).epsilon(0.002).scale(0));
        }
    }

    TEST_CASE("consistency: f and density are 0, not NaN, for wo along the surface or below it") {
        // As when two ends of a path meet on the same plane: then wo is at right angles to n.
        for (float alpha : {0.001f, 0.1f, 1.0f}) {
            Material material = rough(alpha);
            Hit x = metal(material);
            for (Vec3 wo : {Vec3{1, 0, 0}, Vec3{1, 0, -0.0f}, Vec3{0.6f, 0, -0.8f}}) {
                for (Vec3 wi : {Vec3{0, 0, 1}, at(89.9), Vec3{0.6f, 0.8f, 0}}) {
                    CHECK(is_black(ch13::eval_bsdf(x, wo, wi)));
                    CHECK(ch13::pdf_bsdf(x, wo, wi) == 0);
                }
                CHECK(ch13::sample_bsdf(x, wo, 0.5f, {0.3f, 0.7f}).pdf_w == 0);
            }
        }
    }

    TEST_CASE("furnace: rough metal gives back no more than it gets, and smooth metal all") {
        // f cos / pdf = F G2 / G1 <= 1, sample by sample.
        for (float alpha : {0.005f, 0.1f, 0.5f, 1.0f}) {
            for (double degrees : {0.0, 40.0, 75.0}) {
                CAPTURE(alpha);
                CAPTURE(degrees);
                Material material = rough(alpha);
                Hit x = metal(material);
                Vec3 wo = at(degrees);
                RunningStats sampled;
                Sampler random = random_numbers(1);
                for (int i = 0; i < 20000; i++) {
                    BsdfSample s = ch13::sample_bsdf(x, wo, random.u1(), random.u2());
                    float weight = s.pdf_w == 0 ? 0 : s.f.g * dot(s.wi, x.n) / s.pdf_w;
                    REQUIRE(weight <= 1.0001f);
                    sampled.add(static_cast<double>(weight));
                }
                double energy = sampled.mean();
                if (alpha < 0.01f) CHECK(energy > 0.999);
                if (alpha == 1.0f) CHECK(energy < 0.9);
                // The same by quadrature: integral of f cos over wi.
                NormalCells cells{static_cast<double>(alpha)};
                Frame frame(x.n);
                Vec3 o = frame.to_world(wo);
                double integral = sum_of(cells.integrate([&](Vec3 h) {
                    Vec3 n = frame.to_world(h), wi = reflect(o, n);
                    float f = ch13::eval_bsdf(x, o, wi).g * std::max(0.0f, dot(wi, x.n));
                    return static_cast<double>(f * 4 * std::max(0.0f, dot(o, n)));
                }));
                CHECK(std::abs(energy - integral) < 5 * sampled.standard_error() + 0.003);
            }
        }
    }

    TEST_CASE(
        "truth: the share of a white sky that rough metal reflects, by quadrature in double") {
        CHECK(RoughMetal{0.5, 0.2, 3.9}.albedo(pi_exact / 3) ==
              doctest::Approx(0.66274).epsilon(1e-5).scale(0));
        for (auto [alpha, eta, k] : {std::tuple{0.1, 0.2, 3.9}, {0.5, 0.2, 3.9}, {1.0, 1.5, 2.0}}) {
            Material material = rough(static_cast<float>(alpha));
            material.eta.g = static_cast<float>(eta), material.k.g = static_cast<float>(k);
            Hit x = metal(material);
            for (double degrees : {0.0, 45.0, 60.0, 80.0}) {
                CAPTURE(degrees);
                double truth = RoughMetal{alpha, eta, k}.albedo(degrees * pi_exact / 180, 0, 400);
                Vec3 wo = at(degrees);
                // By the metal's own samples, and by even ones, which know nothing of its density.
                RunningStats own, even;
                Sampler random = random_numbers(1);
                for (int i = 0; i < 40000; i++) {
                    float u1 = random.u1();
                    BsdfSample s = ch13::sample_bsdf(x, wo, u1, random.u2());
                    own.add(s.pdf_w == 0 ? 0 : double{s.f.g * dot(s.wi, x.n) / s.pdf_w});
                    Vec3 wi = sample_uniform_hemisphere(random.u2());
                    even.add(double{ch13::eval_bsdf(x, wo, wi).g * wi.z * 2 * pi});
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
    TEST_CASE("identity: without rough metal, light sampling is chapter 11, path by path") {
        for (std::string name : {"cornell-spheres", "two-lights", "thousand-lights"}) {
            CAPTURE(name);
            Scene scene = scene_from("scenes/" + name + ".pbrt", 32, 8);
            Film eleven = film_of(scene, method_of<ch11::trace>(ch11::prepare(scene)), 4).film;
            Film thirteen = film_of(scene, by(Strategy::light, scene), 4).film;
            for (size_t i = 0; i < eleven.pixels().size(); i++)
                REQUIRE(eleven.pixels()[i].mean() == thirteen.pixels()[i].mean());
        }
    }

    TEST_CASE("agreement: both ways find each class of path on Veach's plates alike") {
        Scene scene = scene_from("scenes/veach-mis.pbrt", 32, 6);
        CHECK(check_classes(scene, by(Strategy::bsdf, scene), scene, by(Strategy::light, scene),
                            100000) >= 4);
    }

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
                Measured aimed{a.mean(), a.standard_error()};
                Measured followed{b.mean(), b.standard_error()};
                CHECK(z_between(aimed, followed) < 5);
                CHECK(std::hypot(aimed.se, followed.se) < 0.1 * aimed.mean);
                CHECK(std::abs(std::log(relative_variance(a) / by_aim[plate][lamp])) < 0.5);
                CHECK(std::abs(std::log(relative_variance(b) / by_bsdf[plate][lamp])) < 0.5);
            }
    }
}

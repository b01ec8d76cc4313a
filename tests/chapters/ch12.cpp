// Chapter 12: rough metal, the weights of multiple importance sampling, and all strategies.
#include <doctest/doctest.h>

#include <array>

#include "chapters/11_ris/estimator.h"
#include "chapters/12_mis/estimator.h"
#include "tests/support/estimators.h"

using ch12::Densities, ch12::Heuristic, ch12::Strategy;

namespace {

/// Renders with these settings while it lives.
struct With {
    explicit With(Strategy strategy, Heuristic heuristic = Heuristic::power, int M = 64) {
        ch12::settings = {strategy, heuristic, M};
    }
    ~With() { ch12::settings = {}; }
};
constexpr Strategy all_strategies[] = {Strategy::bsdf, Strategy::light, Strategy::mis,
                                       Strategy::one_sample};

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

/// x^2 or another integrand on [0,1], one sample of each of two densities: MIS as in the chapter.
struct Line {
    double (*f)(double);
    double (*p1)(double), (*p2)(double);
    double (*sample1)(double), (*sample2)(double);

    Densities at(double x) const {
        return {static_cast<float>(p1(x)), 0, static_cast<float>(p2(x))};
    }
    double first(double u) const {
        double x = sample1(u);
        return f(x) / p1(x) * static_cast<double>(mis_weight(&Densities::resampled, at(x)));
    }
    double second(double u) const {
        double x = sample2(u);
        return f(x) / p2(x) * static_cast<double>(mis_weight(&Densities::bsdf, at(x)));
    }
    RunningStats both(int samples) const {
        RunningStats stats;
        Sampler random = random_numbers(1);
        for (int i = 0; i < samples; i++) {
            double u1 = static_cast<double>(random.u1()), u2 = static_cast<double>(random.u1());
            stats.add(first(u1) + second(u2));
        }
        return stats;
    }
    RunningStats one(int samples) const {
        RunningStats stats;
        Sampler random = random_numbers(1);
        for (int i = 0; i < samples; i++) {
            double u = static_cast<double>(random.u1());
            stats.add(2 * (random.u1() < 0.5f ? first(u) : second(u)));
        }
        return stats;
    }
};
const Line square_line = {[](double x) { return x * x; }, [](double) { return 1.0; },
                          [](double x) { return 2 * x; }, [](double u) { return u; },
                          [](double u) { return std::sqrt(u); }};
/// x^-1/2 + (1-x)^-1/2 = 2 (p1 + p2).
const Line two_poles = {[](double x) { return 1 / std::sqrt(x) + 1 / std::sqrt(1 - x); },
                        [](double x) { return 0.5 / std::sqrt(x); },
                        [](double x) { return 0.5 / std::sqrt(1 - x); },
                        [](double u) { return std::pow(u * (1 - 1e-6) + 5e-7, 2); },
                        [](double u) { return 1 - std::pow(u * (1 - 1e-6) + 5e-7, 2); }};
/// The second density sees the left half only.
const Line half_line = {[](double x) { return x * x; }, [](double) { return 1.0; },
                        [](double x) { return x < 0.5 ? 2.0 : 0.0; }, [](double u) { return u; },
                        [](double u) { return u / 2; }};

/// One point of the disk overhead by area, one direction by the cosine: irradiance by MIS.
RunningStats disk_by_both(double h, int samples) {
    RunningStats stats;
    Sampler random = random_numbers(1);
    for (int i = 0; i < samples; i++) {
        double r2 = static_cast<double>(random.u1()), d2 = h * h + r2;
        double pdf_l = d2 * std::sqrt(d2) / (pi_exact * h), cos = h / std::sqrt(d2);
        Densities d{static_cast<float>(pdf_l), 0, static_cast<float>(cos / pi_exact)};
        double X = cos / pdf_l * static_cast<double>(mis_weight(&Densities::resampled, d));
        Vec3 w = sample_cosine_hemisphere(random.u2());
        cos = static_cast<double>(w.z);
        if (h * std::sqrt(1 - cos * cos) < cos) {  // meets the disk, at d = h / cos
            pdf_l = h * h / (cos * cos * cos * pi_exact);
            d = {static_cast<float>(pdf_l), 0, static_cast<float>(cos / pi_exact)};
            X += pi_exact * static_cast<double>(mis_weight(&Densities::bsdf, d));
        }
        stats.add(X);
    }
    return stats;
}

Scene prepared(Scene scene) {
    ch12::prepare(scene);
    return scene;
}
Scene scene_of_file(const std::string& name, int size, int max_depth) {
    return prepared(scene_from("scenes/" + name + ".pbrt", size, max_depth));
}

/// relMSE of one sample for each pixel, over a part of the film.
double rel_mse_of(const Film& film, int x0, int y0, int x1, int y1) {
    double sum = 0, mean = 0, n = static_cast<double>(film.spp);
    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x++) {
            const PixelSum& p = film.pixels()[static_cast<size_t>(y * film.width + x)];
            sum += p.m2 / (n - 1), mean += p.mean;
        }
    double pixels = static_cast<double>((x1 - x0) * (y1 - y0));
    return sum / pixels / (std::pow(mean / pixels, 2) + 0.01);
}

}  // namespace

TEST_SUITE("ch12 rough metal") {
    TEST_CASE("identity: the normals of the facets make up the surface, and what is seen of it") {
        for (double alpha : {0.01, 0.1, 0.5, 1.0}) {
            CAPTURE(alpha);
            NormalCells cells{alpha};
            float a = static_cast<float>(alpha);
            double surface = sum_of(cells.integrate(
                [&](Vec3 h) { return static_cast<double>(ch12::ggx_D(h, a) * h.z); }));
            CHECK(surface == doctest::Approx(1).epsilon(0.002).scale(0));
            for (double degrees : {0.0, 45.0, 80.0}) {
                CAPTURE(degrees);
                Vec3 wo = at(degrees);
                double seen = sum_of(cells.integrate(
                    [&](Vec3 h) { return static_cast<double>(ch12::pdf_ggx_normal(wo, a, h)); }));
                CHECK(seen == doctest::Approx(1).epsilon(0.002).scale(0));
            }
        }
    }

    TEST_CASE("density: GGX normals") {
        for (float alpha : {0.02f, 0.2f, 1.0f})
            for (double degrees : {0.0, 30.0, 85.0}) {
                CAPTURE(alpha);
                CAPTURE(degrees);
                NormalCells cells{static_cast<double>(alpha)};
                Vec3 wo = at(degrees);
                std::vector<double> counts(100), expected = cells.integrate([&](Vec3 h) {
                    return 50000 * static_cast<double>(ch12::pdf_ggx_normal(wo, alpha, h));
                });
                Sampler random = random_numbers(1);
                for (int i = 0; i < 50000; i++)
                    counts[cells.of(ch12::sample_ggx_normal(wo, alpha, random.u2()))]++;
                CHECK(chi_square_chance(counts, expected) > 1e-6);
            }
    }

    TEST_CASE("teeth: normals of all facets fail the test of those that are seen") {
        NormalCells cells{0.2};
        Vec3 wo = at(60);
        std::vector<double> counts(100), expected = cells.integrate([&](Vec3 h) {
            return 50000 * static_cast<double>(ch12::pdf_ggx_normal(wo, 0.2f, h));
        });
        Sampler random = random_numbers(1);
        for (int i = 0; i < 50000; i++)  // as seen from straight above
            counts[cells.of(ch12::sample_ggx_normal({0, 0, 1}, 0.2f, random.u2()))]++;
        CHECK(chi_square_chance(counts, expected) < 1e-6);
    }

    TEST_CASE("density: directions of rough metal, by way of their half vectors") {
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
                    return 50000 * static_cast<double>(ch12::pdf_bsdf(x, wo, wi) * stretch);
                });
                Sampler random = random_numbers(1);
                for (int i = 0; i < 50000; i++) {
                    BsdfSample s = ch12::sample_bsdf(x, wo, random.u1(), random.u2());
                    if (s.pdf_w == 0) continue;  // under the surface
                    counts[cells.of(normalize(frame.to_local(wo) + frame.to_local(s.wi)))]++;
                }
                CHECK(chi_square_chance(counts, expected) > 1e-6);
                CHECK(std::abs(sum_of(counts) - sum_of(expected)) < 5 * std::sqrt(50000 * 0.25));
            }
    }

    TEST_CASE("jacobian: the area of the normals of a small square of u is its area over the pdf") {
        Sampler random = random_numbers(1);
        for (int i = 0; i < 300; i++) {
            float alpha = 0.1f + 0.9f * random.u1();
            Vec3 wo = at(80 * double{random.u1()});
            Vec2 u = {0.05f + 0.9f * random.u1(), 0.05f + 0.9f * random.u1()};
            constexpr float h = 0x1p-9f;
            auto normal = [&](float x, float y) {
                return ch12::sample_ggx_normal(wo, alpha, {x, y});
            };
            Vec3 du = normal(u.x + h, u.y) - normal(u.x - h, u.y);
            Vec3 dv = normal(u.x, u.y + h) - normal(u.x, u.y - h);
            float pdf = ch12::pdf_ggx_normal(wo, alpha, normal(u.x, u.y));
            CHECK(length(cross(du, dv)) / (4 * h * h) ==
                  doctest::Approx(1 / pdf).epsilon(0.02).scale(0));
        }
    }

    TEST_CASE("consistency: invert_ggx_normal finds the numbers of a sample") {
        Sampler random = random_numbers(1);
        for (int i = 0; i < 1000; i++) {
            float alpha = 0.05f + 0.95f * random.u1();
            Vec3 wo = at(85 * double{random.u1()});
            Vec2 u = random.u2();
            Vec2 v = ch12::invert_ggx_normal(wo, alpha, ch12::sample_ggx_normal(wo, alpha, u));
            CHECK(std::abs(u.x - v.x) < 2e-4f);
            CHECK(std::abs(std::remainder(u.y - v.y, 1.0f)) * std::min(u.x, 1 - u.x) < 2e-4f);
        }
    }

    TEST_CASE("consistency: samples, values and densities agree; f is the same both ways round") {
        Sampler random = random_numbers(1);
        for (int i = 0; i < 5000; i++) {
            Material material = rough(0.01f + 0.99f * random.u1(), 3);
            Hit x = metal(material);
            Vec3 wo = at(89 * double{random.u1()});
            BsdfSample s = ch12::sample_bsdf(x, wo, random.u1(), random.u2());
            CHECK(!s.specular);
            if (s.pdf_w == 0) continue;
            CHECK(std::isfinite(s.pdf_w));
            CHECK(is_finite(s.f));
            CHECK(length(s.wi) == doctest::Approx(1).epsilon(1e-5).scale(0));
            CHECK(ch12::pdf_bsdf(x, wo, s.wi) == s.pdf_w);
            CHECK(ch12::eval_bsdf(x, wo, s.wi) == s.f);
            CHECK(ch12::eval_bsdf(x, s.wi, wo).g ==
                  doctest::Approx(double{s.f.g}).epsilon(0.002).scale(0));
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
                    BsdfSample s = ch12::sample_bsdf(x, wo, random.u1(), random.u2());
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
                    float f = ch12::eval_bsdf(x, o, wi).g * std::max(0.0f, dot(wi, x.n));
                    return static_cast<double>(f * 4 * std::max(0.0f, dot(o, n)));
                }));
                CHECK(std::abs(energy - integral) < 5 * sampled.standard_error() + 0.003);
            }
        }
    }

    TEST_CASE("furnace: a ball of nearly smooth metal shows what a smooth one reflects") {
        auto ball = [](const std::string& roughness) {
            Scene scene = prepared(world_of(
                "LightSource \"infinite\" Material \"conductor\" \"rgb reflectance\" [.9 .8 .5]"
                " \"float roughness\" " +
                roughness +
                " \"bool remaproughness\" false"
                " Shape \"sphere\""));
            return film_of(scene, ch12::trace, 64).film;
        };
        With settings(Strategy::bsdf);  // finds the sky without noise: each sample is F G2 / G1
        Film smooth = ball("0"), rough = ball("0.01");
        for (int y = 10; y < 22; y++)
            for (int x = 10; x < 22; x++) {
                size_t i = static_cast<size_t>(32 * y + x);
                CHECK(rough.pixels()[i].mean ==
                      doctest::Approx(smooth.pixels()[i].mean).epsilon(0.005).scale(0));
            }
    }
}

TEST_SUITE("ch12 weights") {
    TEST_CASE("identity: MIS weights sum to 1") {
        const float inf = infinity;
        std::vector<Densities> table = {{1, 2, 3},           {0, 0, 5},
                                        {3e19f, 1, 3e19f},   {1e-23f, 1e-24f, 0},
                                        {3e38f, 1e-38f, 1},  {inf, 1, 2},
                                        {0, 7, inf},         {1e-38f, 1e-38f, 1e-38f},
                                        {1e-45f, 0, 1e-40f}, {3e38f, 3e38f, 3e38f}};
        Sampler random = random_numbers(1);
        for (int i = 0; i < 10000; i++) {
            auto density = [&] { return std::pow(10.0f, 20 * random.u1() - 10); };
            float a = density(), b = density();
            table.push_back({a, b, density()});
        }
        for (Heuristic heuristic : {Heuristic::balance, Heuristic::power}) {
            With settings(Strategy::mis, heuristic);
            for (const Densities& d : table) {
                CAPTURE(d.resampled);
                CAPTURE(d.uniform);
                CAPTURE(d.bsdf);
                double sum = 0;
                for (auto way : {&Densities::resampled, &Densities::uniform, &Densities::bsdf}) {
                    if (d.*way == 0) continue;  // draws nothing
                    float weight = mis_weight(way, d);
                    CHECK(weight >= 0);
                    CHECK(weight <= 1);
                    sum += static_cast<double>(weight);
                }
                CHECK(sum == doctest::Approx(1).epsilon(1e-6).scale(0));
            }
        }
    }

    TEST_CASE("failure: p^2 / (p^2 + q^2) is NaN for large and for small densities") {
        auto naive = [](float a, float b) { return a * a / (a * a + b * b); };
        CHECK(std::isnan(naive(3e19f, 1)));
        CHECK(std::isnan(naive(1e-23f, 1e-24f)));
        CHECK(mis_weight(&Densities::bsdf, {1, 0, 3e19f}) == 1);
        CHECK(mis_weight(&Densities::bsdf, {1e-24f, 0, 1e-23f}) ==
              doctest::Approx(1 / 1.01).epsilon(1e-6).scale(0));
    }

    TEST_CASE("truth: MIS in one dimension") {
        struct Row {
            const Line& line;
            Heuristic heuristic;
            double mean, variance;
        };
        for (auto [line, heuristic, mean, variance] :
             {Row{square_line, Heuristic::balance, 1.0 / 3, 0.01872105860672},
              {square_line, Heuristic::power, 1.0 / 3, 0.01817598677553},
              {two_poles, Heuristic::power, 4, 8.0 / 15},
              {half_line, Heuristic::balance, 1.0 / 3, 0.1016975308642}}) {
            With settings(Strategy::mis, heuristic);
            RunningStats s = line.both(400000);
            check_mean(s, mean, variance, 0.01 * mean + 0.01);
            check_variance(s, variance, 4);
        }
    }

    TEST_CASE("truth: one sample by a coin is the mixture of both densities: variance 0.04089") {
        With settings(Strategy::one_sample, Heuristic::balance);
        RunningStats s = square_line.one(400000);
        check_mean(s, 1.0 / 3, 0.04088549026398, 0.01);
        check_variance(s, 0.04088549026398, 3);
        CHECK(s.variance() > 2 * 0.01872105860672);  // one of each is better than half of two
    }

    TEST_CASE("identity: where f is the sum of both densities, every pair of samples is exact") {
        // Each density alone has infinite variance.
        With settings(Strategy::mis, Heuristic::balance);
        RunningStats both = two_poles.both(10000), one = two_poles.one(10000);
        CHECK(both.mean() == doctest::Approx(4).epsilon(1e-5).scale(0));
        CHECK(std::sqrt(both.variance()) < 1e-5);
        CHECK(std::sqrt(one.variance()) < 1e-5);
    }

    TEST_CASE("variance: a disk overhead by area and by the cosine") {
        struct Row {
            double h, balance, power;
        };
        for (auto [h_here, balance, power] : {Row{1, 0.1718126459636, 0.1287833300175},
                                              {0.5, 0.1781064946388, 0.2237023499149},
                                              {0.1, 0.1088012149308, 0.09025985025283}}) {
            const auto& h = h_here;
            CAPTURE(h);
            double E = pi_exact / (1 + h * h);
            for (Heuristic heuristic : {Heuristic::balance, Heuristic::power}) {
                With settings(Strategy::mis, heuristic);
                double relative = heuristic == Heuristic::balance ? balance : power;
                RunningStats s = disk_by_both(h, 400000);
                check_mean(s, E, relative * E * E, 0.01 * E);
                check_variance(s, relative * E * E, 20);
            }
        }
    }

    TEST_CASE("failure: a density per area beside one per solid angle: 0.881, 1.105, 1.318") {
        // The light's samples weigh with the right density, the BSDF's with 1 / area.
        With settings(Strategy::mis, Heuristic::balance);
        for (auto [h_here, wrong] :
             {std::pair{0.5, 0.8809532795696}, {1.0, 1.105316968821}, {2.0, 1.317990844865}}) {
            const auto& h = h_here;
            CAPTURE(h);
            // Irradiance of the disk, over z = cos: 2 pi z dz from h / sqrt(1 + h^2) to 1.
            double low = h / std::sqrt(1 + h * h), right = 0, mixed = 0, both_wrong = 0;
            for (int i = 0; i < 10000; i++) {
                double z = low + (1 - low) * (i + 0.5) / 10000;
                double light = h * h / (z * z * z * pi_exact), raw = 1 / pi_exact;
                auto share = [&](float Densities::*way, double pdf_l) {
                    Densities d{static_cast<float>(pdf_l), 0, static_cast<float>(z / pi_exact)};
                    return static_cast<double>(mis_weight(way, d));
                };
                right += z * (share(&Densities::resampled, light) + share(&Densities::bsdf, light));
                mixed += z * (share(&Densities::resampled, light) + share(&Densities::bsdf, raw));
                both_wrong +=
                    z * (share(&Densities::resampled, raw) + share(&Densities::bsdf, raw));
            }
            CHECK(mixed / right == doctest::Approx(wrong).epsilon(1e-4).scale(0));
            CHECK(both_wrong / right == doctest::Approx(1).epsilon(1e-6).scale(0));
        }
    }
}

TEST_SUITE("ch12 mis") {
    TEST_CASE("truth: irradiance of all lights, by every strategy") {
        const std::string near_and_far =
            "AttributeBegin " + shining + unit_square(1) + "AttributeEnd AttributeBegin " +
            shining + "Rotate 90 0 1 0 " + unit_square(1, 1.5) + "AttributeEnd\n";
        for (const auto& [light_here, E] : std::vector<std::pair<std::string, double>>{
                 {shining + disk(1, 1), 1.570796326795},
                 {shining + unit_square(0.1), 3.04212843837},
                 {shining + "Translate 2 0 0 Shape \"sphere\"", 0.09058607370608},
                 {near_and_far, 0.7522746884541 + 0.1046370751909},
                 {"LightSource \"infinite\"", pi_exact},
                 {"LightSource \"infinite\" " + shining + unit_square(1), pi_exact}}) {
            const auto& light = light_here;
            CAPTURE(light);
            Scene scene = prepared(floor_under(light));
            for (Strategy strategy : all_strategies)
                for (Heuristic heuristic : {Heuristic::balance, Heuristic::power}) {
                    With settings(strategy, heuristic);
                    CAPTURE(static_cast<int>(strategy));
                    bool rare = strategy == Strategy::bsdf || strategy == Strategy::one_sample;
                    check_bounded(irradiance(scene, ch12::trace, rare ? 60000 : 20000), E, 0.025);
                }
        }
    }

    TEST_CASE("truth: point and distant lights, which only aiming finds") {
        for (const auto& [light, E] : std::vector<std::pair<std::string, double>>{
                 {"LightSource \"point\" \"point3 from\" [1 2 0]", 0.1788854382},
                 {"LightSource \"distant\" \"point3 from\" [0 3 4] \"point3 to\" [0 0 0]", 0.6}}) {
            Scene scene = prepared(floor_under(light));
            for (Strategy strategy : {Strategy::light, Strategy::mis}) {
                With settings(strategy);
                RunningStats s = irradiance(scene, ch12::trace, 100);
                CHECK(s.mean() == doctest::Approx(E).epsilon(1e-5).scale(0));
                CHECK(s.variance() < 1e-10);
            }
            With settings(Strategy::one_sample);  // twice, or nothing
            check_mean(irradiance(scene, ch12::trace, 40000), E, E * E, 0.05);
        }
    }

    TEST_CASE("truth: a light in a mirror and straight on, by every strategy, without noise") {
        Scene mirror = prepared(world_of(
            "Material \"conductor\" \"rgb reflectance\" [.9 .9 .9] Shape \"sphere\"\n" + shining +
            "Translate 0 0 -9 Rotate -90 1 0 0 Scale 9 1 9 " + square(0, false)));
        for (Strategy strategy : all_strategies) {
            With settings(strategy);
            RunningStats s = repeat(mirror, {{0, 0, -4}, {0, 0, 1}}, ch12::trace, 100);
            CHECK(s.mean() == doctest::Approx(0.9).epsilon(1e-5).scale(0));
            CHECK(s.variance() < 1e-10);
            s = repeat(mirror, {{0, 0, -4}, {0, 0, -1}}, ch12::trace, 100);
            CHECK(s.mean() == 1);
            CHECK(s.variance() == 0);
        }
    }

    TEST_CASE("failure: without lights the picture is black") {
        Scene none = floor_under(shining + unit_square(1));
        none.lights.clear();
        for (Shape& shape : none.shapes) shape.light = -1;
        ch12::prepare(none);
        CHECK(irradiance(none, ch12::trace, 100).mean() == 0);
    }

    TEST_CASE("agreement: all strategies and heuristics on rough, smooth and matt surfaces") {
        for (std::string name : {"veach-mis", "cornell-spheres"}) {
            CAPTURE(name);
            Scene scene = scene_of_file(name, 32, 6);
            Film mis = film_of(scene, ch12::trace, 96).film;
            for (Strategy strategy : all_strategies) {
                CAPTURE(static_cast<int>(strategy));
                With settings(strategy, Heuristic::balance);
                Film film = film_of(scene, ch12::trace, 128, 2).film;
                Agreement a = hold_against(film, mis, 16);
                check_agreement(a, 0.2);
            }
        }
    }

    TEST_CASE("agreement: pictures, lengths and classes of paths with chapter 11") {
        for (const auto& [name_here, least] :
             std::vector<std::pair<std::string, int>>{{"cornell", 6},
                                                      {"cornell-spheres", 8},
                                                      {"two-lights", 4},
                                                      {"far-and-near", 2},
                                                      {"color-bleeding", 6},
                                                      {"thousand-lights", 4},
                                                      {"near-light", 2},
                                                      {"light-in-glass", 4},
                                                      {"horizon-sky", 2}}) {
            const auto& name = name_here;
            CAPTURE(name);
            Scene scene = scene_from("scenes/" + name + ".pbrt", 32, 8);
            Scene scene_11 = scene;
            ch11::prepare(scene_11);
            CHECK(check_classes(scene_11, ch11::trace, prepared(scene), ch12::trace, 20000) >=
                  least);
        }
    }

    TEST_CASE("agreement: classes of path by each strategy on Veach's plates") {
        Scene scene = scene_of_file("veach-mis", 32, 6);
        Scene alone = scene;
        PathCensus mis = census_of(scene, ch12::trace, 60000, 1);
        for (Strategy strategy : {Strategy::bsdf, Strategy::light, Strategy::one_sample}) {
            With settings(strategy);
            PathCensus census = census_of(alone, ch12::trace, 100000, 2);
            CHECK(census.worst_sum < 1e-5);
            for (auto& [name_here, part] : mis.by_class) {
                const auto& name = name_here;
                if (part.not_zero < 200 || census.by_class[name].not_zero < 200) continue;
                CAPTURE(name);
                CHECK(z_between(part.measured(mis.paths),
                                census.by_class[name].measured(census.paths)) < 5);
            }
        }
    }

    TEST_CASE("variance: on every plate, MIS has less noise than either strategy alone") {
        Scene scene = scene_of_file("veach-mis", 128, 8);
        auto film = [&](Strategy strategy) {
            With settings(strategy);
            return film_of(scene, ch12::trace, 32).film;
        };
        Film mis = film(Strategy::mis), bsdf = film(Strategy::bsdf), light = film(Strategy::light);
        for (auto [y0_here, y1] : {std::pair{57, 66}, {72, 81}, {85, 95}, {99, 110}}) {
            const auto& y0 = y0_here;
            CAPTURE(y0);
            double m = rel_mse_of(mis, 16, y0, 112, y1), b = rel_mse_of(bsdf, 16, y0, 112, y1),
                   l = rel_mse_of(light, 16, y0, 112, y1);
            CHECK(m < b);
            CHECK(m < l);
        }
    }
}

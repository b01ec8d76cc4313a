// Chapter 11: light importance: the alias table, powers, and where power misleads.
#include <doctest/doctest.h>

#include <numeric>

#include "chapters/10_cosine_sampling/estimator.h"
#include "chapters/11_light_importance/estimator.h"
#include "tests/support/known_lights.h"

namespace {

/// Two point lights straight up: 1000 times the power from 1000 m, and one from 1 m.
struct FarAndNear {
    Scene scene = floor_under(
        "LightSource \"point\" \"float scale\" 1000 \"point3 from\" [0 1000 0]\n"
        "LightSource \"point\" \"point3 from\" [0 1 0]");
    double E[2] = {1000 / 1e6, 1};

    /// Relative variance of one of the two, chosen by pmf.
    double relative_variance(const std::vector<double>& pmf) const {
        double squares = E[0] * E[0] / pmf[0] + E[1] * E[1] / pmf[1];
        return squares / std::pow(E[0] + E[1], 2) - 1;
    }
};

/// Kurtosis of a number that has one of two values, one of them with probability p.
double kurtosis_of_two(double p) { return (1 - 3 * p * (1 - p)) / (p * (1 - p)); }

const Method trace_10 = method_of<ch10::trace>();
Method trace_11(const Scene& scene) { return method_of<ch11::trace>(ch11::prepare(scene)); }

}  // namespace

TEST_SUITE("ch11 light table") {
    TEST_CASE("identity: over all 2^24 random numbers each light gets its share") {
        Sampler random = random_numbers(2);
        for (size_t N : {100u, 1000000u}) {
            CAPTURE(N);
            std::vector<double> pmf(N), share(N);
            for (double& p : pmf) p = std::pow(1e-8, double{random.u1()});
            double sum = std::accumulate(pmf.begin(), pmf.end(), 0.0);
            for (double& p : pmf) p /= sum;
            ch11::LightTable table = ch11::build_light_table(pmf);
            for (size_t i = 0; i < N; i++) {  // what a column has of each of its two lights
                double own = double{table[i].own};
                share[i] += own / static_cast<double>(N);
                share[table[i].other] += (1 - own) / static_cast<double>(N);
            }
            int off = 0;
            for (size_t i = 0; i < N; i++)
                off +=
                    std::abs(share[i] - pmf[i]) > 1e-6 * pmf[i] + 1e-7 / static_cast<double>(N) ||
                    table[i].pmf != nearly(pmf[i]);
            CHECK(off == 0);
            // And numbers fall to them accordingly, but for one in each column.
            constexpr int numbers = 1 << 24;
            std::vector<double> counts(N);
            for (int k = 0; k < numbers; k++) counts[ch11::pick_light(table, k * 0x1p-24)]++;
            double most = 0;
            for (size_t i = 0; i < N; i++)
                most = std::max(most, std::abs(counts[i] * 0x1p-24 - share[i]) * 0x1p24);
            CHECK(most < (N == 100 ? 150 : 2000));
        }
    }

    TEST_CASE("failure: a light of probability 0 is never chosen, not by 0 and not by rounding") {
        for (const std::vector<double>& pmf :
             std::vector<std::vector<double>>{{0, 0.3, 0.7, 0},
                                              {0, 1},
                                              {1, 0},
                                              {0, 0, 0.5, 0, 0.5, 0, 0},
                                              {1e-12, 0, 1 - 1e-12}}) {
            ch11::LightTable table = ch11::build_light_table(pmf);
            for (uint32_t i = 0; i < 4096; i++)
                CHECK(pmf[ch11::pick_light(table, static_cast<float>(i) / 4096)] > 0);
            for (float u : {0x1p-24f, 0x1.fffffep-1f, std::nextafter(0.5f, 0.0f)})
                CHECK(pmf[ch11::pick_light(table, u)] > 0);
        }
    }

    TEST_CASE("truth: powers of lights") {
        // A sky or sun shines through the disk of the scene's radius; from all sides, or one.
        const double R2 = 500 * 500 * 2, lamp = 4 * pi_exact;
        const std::string area = "AreaLightSource \"diffuse\" ";
        for (const auto& [light, power] : std::vector<std::pair<std::string, double>>{
                 {area + square(1, false), lamp},
                 {area + "\"rgb L\" [1 2 6] " + square(1, false), 3 * lamp},
                 {area + "\"bool twosided\" true " + square(1, false), 2 * lamp},
                 {area + "\"float power\" 5 Shape \"sphere\"", 5},
                 {"LightSource \"point\" \"float power\" 100", 100},
                 {"LightSource \"infinite\"", 4 * pi_exact * pi_exact * R2},
                 {"LightSource \"distant\"", pi_exact * R2}}) {
            CAPTURE(light);
            CHECK(ch11::light_power(floor_under(light), 0) == nearly(power, 1e-5));
        }
    }

    TEST_CASE("density: lights are chosen by their power, and pdf_w has the choice in it") {
        ch11::LightTable table = ch11::prepare(ten_lamps());
        std::array<double, 10> pmf{};
        for (size_t i = 0; i < 10; i++) pmf[i] = 0.75 * static_cast<double>(i + 1) / 55 + 0.25 / 10;
        check_choice(pmf, [&](const Scene& scene, const Hit& x, Sampler& random) {
            double u = double{random.u1()};
            return ch11::sample_light(scene, table, x, u, random.u2());
        });
    }
}

TEST_SUITE("ch11 light importance") {
    TEST_CASE("truth: far bright and near weak: power 998, all alike 0.996, half of each 2.98") {
        FarAndNear lights;
        for (auto [d, relative] :
             {std::pair{0.0, 998.001}, {1.0, 0.996007988016}, {0.5, 2.98405317204}})
            CHECK(lights.relative_variance(ch11::light_pmf(lights.scene, d)) ==
                  nearly(relative, 1e-5));
        // Without any power all are alike.
        for (Light& light : lights.scene.lights) light.L = {};
        CHECK(ch11::light_pmf(lights.scene, 0) == std::vector{0.5, 0.5});
    }

    TEST_CASE("variance: the chapter's d bounds it by N / d, and the measured one agrees") {
        FarAndNear lights;
        std::vector<double> pmf = ch11::light_pmf(lights.scene, 0.25);
        double relative = lights.relative_variance(pmf), E = lights.E[0] + lights.E[1];
        CHECK(relative < 2 / 0.25);
        RunningStats s = irradiance(lights.scene, trace_11(lights.scene), 100000);
        check_mean(s, E, relative * E * E, 0.1);
        check_variance(s, relative * E * E, kurtosis_of_two(pmf[1]));
    }

    TEST_CASE("variance: a thousand lights: a third of the relMSE of chapter 10") {
        Scene scene = scene_from("scenes/thousand-lights.pbrt", 32, 8);
        CHECK(rel_mse(scene, trace_11(scene), 256) < rel_mse(scene, trace_10, 256) / 3);
    }

    TEST_CASE("failure: where the bright light is far or hidden, worse than chapter 10") {
        for (std::string name : {"far-and-near", "hidden-light"}) {
            CAPTURE(name);
            Scene scene = scene_from("scenes/" + name + ".pbrt", 32, 8);
            double before = rel_mse(scene, trace_10, 128);
            double now = rel_mse(scene, trace_11(scene), 128);
            CHECK(now > 1.2 * before);
            CHECK(now < 8.5 * before);  // but not by more than N / d
        }
    }
}

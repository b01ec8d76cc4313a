// Chapter 15: which two lights are sampled, how likely each is, and that no heuristic moves the
// mean.
#include <doctest/doctest.h>

#include <numeric>
#include <utility>

#include "chapters/12_ris/estimator.h"
#include "chapters/15_mis_ris/estimator.h"
#include "tests/support/known_lights.h"

namespace {

Method by_twelve(const Scene& scene) { return method_of<ch12::trace>(ch12::prepare(scene, 16)); }
Method by_fifteen(const Scene& scene, int M = 64) {
    return method_of<ch15::trace>(ch15::prepare(scene, M));
}

/// Three lights of very unequal power and distance over a floor.
Scene three_lights() {
    return floor_under(
        black_lamp("1", unit_square(0.5, 1.5)) + black_lamp("20", disk(0.5, 3, 1)) +
        black_lamp("300", "Translate -1 2 1 Shape \"sphere\" \"float radius\" 0.1\n"));
}
template <class Number>
double sum_of(const std::vector<Number>& numbers) {
    return std::accumulate(numbers.begin(), numbers.end(), 0.0);
}

/// Inclusion probabilities by the page's formula, in double precision, with c by bisection. One or
/// two lights are always included.
std::vector<double> inclusions(const std::vector<double>& w) {
    if (w.size() <= 2) return std::vector(w.size(), 1.0);
    double mean = sum_of(w) / static_cast<double>(w.size()), low = 1e-30, high = 1e30;
    auto with = [&](double c) {
        std::vector<double> result;
        for (double w_i : w) result.push_back(std::min(1.0, c * (w_i + mean / 9)));
        return result;
    };
    for (int k = 0; k < 100; k++) {
        double middle = std::sqrt(low * high);
        (sum_of(with(middle)) < 2 ? low : high) = middle;
    }
    return with(high);
}

}  // namespace

TEST_SUITE("ch15 two lights") {
    TEST_CASE("identity: inclusions are min(1, c (w + mean w / 9)), and sum to 2") {
        const std::string far =
            shining + "Translate 9 9 9 Shape \"sphere\" \"float radius\" 1e-3\n";
        for (const Scene& scene : {all_kinds(), scene_from("scenes/thousand-lights.pbrt", 16, 1),
                                   world_of(far), world_of("LightSource \"infinite\"\n" + far)}) {
            Sampler random = random_numbers(1);
            for (int k = 0; k < 2000; k++) {
                int N = static_cast<int>(scene.lights.size()), M = 3 + k % 70,
                    size = std::min(N, M);
                ch15::Lights lights = ch15::prepare(scene, M);
                REQUIRE(std::abs(sum_of(lights.candidates) - size) < 1e-3);
                REQUIRE(std::ranges::max(lights.candidates) < 1.00001f);
                Hit x = somewhere(scene, random);
                double u = to_unit_double(random.u2());
                ch15::Candidates c;
                ch15::choose_candidates(lights, x, x.n, u, c);
                ch15::compute_inclusions(scene, lights, c);
                if (c.size == 0 && N > 2) continue;
                REQUIRE(c.size == size);
                int always = static_cast<int>(lights.always.size());
                std::vector<double> w;
                for (int i = 0; i < size; i++) {
                    size_t light = c.light[i], number = static_cast<size_t>(i);
                    double drawn = size - always, slice = (i - always + u) / drawn;
                    REQUIRE(light == (N <= M       ? number
                                      : i < always ? lights.always[number]
                                                   : pick_light(lights.table, slice)));
                    double share = double{pmf_light(lights.table, light)};
                    double candidates = i < always ? 1 : drawn * share;
                    w.push_back(p_hat_by_type(scene, light, x) / candidates);
                }
                std::vector<double> expected = inclusions(w);
                double sum = 0;
                for (size_t i = 0; i < w.size(); i++) {
                    REQUIRE(std::abs(double{c.inclusion[i]} - expected[i]) < 1e-3);
                    sum += double{c.inclusion[i]};
                }
                REQUIRE(std::abs(sum - std::min(N, 2)) < 1e-3);
            }
        }
    }

    TEST_CASE("identity: a drawn light has at least a tenth of the mean power of those drawn") {
        // Three that are always candidates, four that are drawn, and two without power.
        std::string lights;
        for (const char* scale : {"9000", "9000", "9000", "1", "1", "1", "1", "1", "1"})
            lights += "LightSource \"point\" \"float scale\" " + std::string(scale) + "\n";
        Scene scene = floor_under(lights);
        scene.lights[7].L = scene.lights[8].L = {};
        ch15::Lights of_five = ch15::prepare(scene, 5);
        CHECK(of_five.always.size() == 3);
        double least = 1.0 / 6 / 10;
        for (size_t i : {7u, 8u})
            CHECK(pmf_light(of_five.table, i) == nearly(least / (1 + 2 * least), 1e-5));
    }

    TEST_CASE("failure: no light gives anything: no candidate; beyond float: a sample is seen") {
        Scene scene = three_lights();
        for (Light& light : scene.lights) light.L = {};
        ch15::Candidates c;
        Hit x = origin_of(scene);
        ch15::Lights dark = ch15::prepare(scene);
        ch15::choose_candidates(dark, x, x.n, 0, c);
        ch15::compute_inclusions(scene, dark, c);
        CHECK(c.size == 0);
        for (Light& light : scene.lights) light.L = {2e38f, 2e38f, 2e38f};
        Sampler random = random_numbers(1);
        Recorder recorder;
        CHECK(!is_finite(ch15::trace(scene, ch15::prepare(scene), onto_origin, random, recorder)));
    }
}

TEST_SUITE("ch15 mis ris") {
    TEST_CASE(
        "variance: a thousand lights over rough metal: lobes that turn away are not sampled") {
        // Without bsdf_factor() it was 5 times as much.
        Scene scene = scene_from("scenes/thousand-lights.pbrt", 48, 1);
        Material& floor = scene.materials[scene.shapes[0].material];
        REQUIRE(floor.reflectance.r == 0.6f);
        floor.type = MaterialType::conductor, floor.alpha = 0.2f;
        floor.eta = {0.2f, 0.2f, 0.2f}, floor.k = {3, 3, 3};
        CHECK(rel_mse(scene, by_fifteen(scene), 16) < 1);
    }

    TEST_CASE("variance: a thousand lights: a third of the relMSE of chapter 12") {
        Scene scene = scene_from("scenes/thousand-lights.pbrt", 64, 8);
        CHECK(rel_mse(scene, by_fifteen(scene), 16) < rel_mse(scene, by_twelve(scene), 16) / 3);
    }

    TEST_CASE("variance: a bright light behind a wall: both lights are sampled") {
        Scene scene = scene_from("scenes/hidden-light.pbrt", 32, 8);
        CHECK(rel_mse(scene, by_fifteen(scene), 64) < rel_mse(scene, by_twelve(scene), 64) / 10);
    }
}

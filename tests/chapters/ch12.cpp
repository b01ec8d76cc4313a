// Chapter 12: resampled importance sampling: the four-light example in full, the target, and walls.
#include <doctest/doctest.h>

#include <array>
#include <tuple>
#include <utility>

#include "chapters/11_light_importance/estimator.h"
#include "chapters/12_ris/estimator.h"
#include "common/base/parallel.h"
#include "tests/support/estimators.h"

namespace {

/// Four lights: probabilities, targets, and what they really give (the second is in shadow).
using Four = std::array<double, 4>;
constexpr Four p = {0.4, 0.3, 0.2, 0.1}, p_hat = {1, 2, 4, 8}, f = {1, 0, 4, 8};

/// Calls visit(lights, probability) for all 4^M ways to draw M candidates.
template <class Visit>
void for_each_tuple(size_t M, const Four& pmf, const Visit& visit) {
    std::vector<size_t> lights(M);
    for (size_t code = 0; code < size_t{1} << (2 * M); code++) {
        double probability = 1;
        for (size_t k = 0; k < M; k++) {
            lights[k] = code >> (2 * k) & 3;
            probability *= pmf[lights[k]];
        }
        visit(lights, probability);
    }
}

struct MeanVariance {
    double mean = 0, variance = 0;
};

/// What the chapter's Reservoir makes of the candidates from number k on: sums of probability f W
/// and of its square, over the two ways in which each decision can fall.
struct Sums {
    double first = 0, second = 0;
};
void follow(const ch12::Reservoir& kept, const std::vector<size_t>& lights, size_t k,
            double probability, const Four& pmf, const Four& target, Sums& sums) {
    if (k == lights.size()) {
        double X = f[kept.light] * static_cast<double>(kept.W(static_cast<int>(k)));
        sums.first += probability * X;
        sums.second += probability * X * X;
        return;
    }
    size_t light = lights[k];
    double weight = target[light] / pmf[light];
    double share = weight > 0 ? weight / (static_cast<double>(kept.weight_sum) + weight) : 0;
    for (bool taken : {true, false}) {
        double chance = taken ? share : 1 - share;
        if (chance == 0) continue;
        // u decides, and is uniform again afterwards: 0.3 of the way through either part.
        float u = static_cast<float>(taken ? 0.3 * share : share + 0.3 * (1 - share));
        ch12::Reservoir next = kept;
        next.offer(light, static_cast<float>(target[light]), static_cast<float>(weight), u);
        CHECK(u == doctest::Approx(0.3).epsilon(1e-5).scale(0));
        CHECK(next.light == (taken ? light : kept.light));
        follow(next, lights, k + 1, probability * chance, pmf, target, sums);
    }
}

/// Mean and variance of f W over all tuples of M candidates.
MeanVariance resampled(size_t M, const Four& pmf, const Four& target) {
    Sums sums;
    for_each_tuple(M, pmf, [&](const std::vector<size_t>& lights, double probability) {
        follow({}, lights, 0, probability, pmf, target, sums);
    });
    return {sums.first, sums.second - sums.first * sums.first};
}

/// The mean of f W where candidates are drawn one after the other and none twice, but are weighed
/// as if each had been drawn from all four.
double mean_without_replacement(size_t M) {
    Sums sums;
    for_each_tuple(M, p, [&](const std::vector<size_t>& lights, double) {
        double probability = 1, left = 1;
        Four chance = p;
        for (size_t light : lights) {
            probability *= chance[light] / left;
            left -= std::exchange(chance[light], 0);
        }
        if (probability > 0) follow({}, lights, 0, probability, p, p_hat, sums);
    });
    return sums.first;
}

/// The mean of weight(lights, k, sum of target/p) f over all tuples, k kept by its `choice` share.
template <class Choice, class Weight>
double mean_of(size_t M, const Choice& choice, const Weight& weight) {
    double mean = 0;
    for_each_tuple(M, p, [&](const std::vector<size_t>& lights, double probability) {
        double chances = 0, sum = 0;
        for (size_t i : lights) chances += choice(i), sum += p_hat[i] / p[i];
        for (size_t i : lights)
            mean += probability * choice(i) / chances * f[i] * weight(i, choice(i) / chances, sum);
    });
    return mean;
}

auto is(double x) { return doctest::Approx(x).epsilon(1e-5).scale(0); }

/// Chapters 11 and 12 in this scene; M as in the program without options.
Method trace_11(const Scene& scene) { return method_of<ch11::trace>(ch11::prepare(scene)); }
Method trace_12(const Scene& scene, int M = 16) {
    return method_of<ch12::trace>(ch12::prepare(scene, M));
}

/// hidden-light.pbrt with this radiance of the lamp in the other room.
Scene hidden_light(const std::string& L) {
    std::string text = read_file("scenes/hidden-light.pbrt"), was = "140000 133000 122000";
    size_t at = text.find("[" + was + "]");
    REQUIRE(at != std::string::npos);
    Scene scene = scene_of(text.replace(at + 1, was.size(), L));
    scene.width = scene.height = 32, scene.max_depth = 8;
    return scene;
}

/// Ten point lights in a ring over the origin, of very different power, two of them in shadow.
struct Ring {
    Scene scene;
    std::vector<double> given, target, pmf;
    double E = 0;

    Ring() {
        std::string lights =
            "AttributeBegin Material \"diffuse\" \"rgb reflectance\" [0 0 0]"
            " Translate 0 0.2 0.6 Scale 0.2 1 0.2 " +
            square(0, true) + "AttributeEnd\n";
        for (int i = 0; i < 10; i++) {
            double angle = 2 * pi_exact * i / 10, height = 0.3 + 0.2 * i;
            double power = std::pow(2.0, i * 7 % 10), d2 = 1 + height * height;
            Vec3 at = {static_cast<float>(std::sin(angle)), static_cast<float>(height),
                       static_cast<float>(std::cos(angle))};
            lights += "LightSource \"point\" \"float scale\" " + std::to_string(power) +
                      " \"point3 from\" [" + std::to_string(at.x) + " " + std::to_string(at.y) +
                      " " + std::to_string(at.z) + "]\n";
            target.push_back(power * height / (d2 * std::sqrt(d2)));
        }
        scene = floor_under(lights);
        LightTable table = ch12::prepare(scene, 1).lights;
        Hit x = origin_of(scene);
        for (size_t i = 0; i < 10; i++) {
            Vec3 to_y = scene.lights[i].p;
            bool dark = occluded(scene, spawn_ray(x, normalize(to_y), length(to_y)));
            given.push_back(dark ? 0 : target[i]);
            pmf.push_back(static_cast<double>(pmf_light(table, i)));
            E += given.back();
        }
    }
    /// E[(f/q)^n] for f drawn by q.
    double moment(const std::vector<double>& q, int n) const {
        double sum = 0;
        for (size_t i = 0; i < 10; i++) sum += q[i] * std::pow(given[i] / q[i], n);
        return sum;
    }
};

}  // namespace

TEST_SUITE("ch12 reservoir") {
    TEST_CASE("truth: RIS on four lights, all tuples") {
        for (auto [M, variance] : {std::pair{size_t{1}, 553.5},
                                   {2, 289.75},
                                   {3, 201.8333333333},
                                   {4, 157.875},
                                   {5, 131.5}}) {
            MeanVariance result = resampled(M, p, p_hat);
            CHECK(result.mean == is(13));
            CHECK(result.variance == is(variance));
        }
        MeanVariance perfect = resampled(4, p, f);
        CHECK(perfect.mean == is(13));
        CHECK(perfect.variance == is(138.375));
        MeanVariance even = resampled(4, {0.25, 0.25, 0.25, 0.25}, p_hat);
        CHECK(even.mean == is(13));
        CHECK(even.variance == is(58.25));
    }

    TEST_CASE(
        "truth: without the weight W, or with a wrong one, the four lights give 3.66, 8, 52") {
        auto by_target = [](size_t i) { return p_hat[i]; };
        auto by_ratio = [](size_t i) { return p_hat[i] / p[i]; };
        // Candidates by p, one kept in proportion to p_hat / p, or to p_hat as the slide has it;
        // truth 13.
        CHECK(mean_of(4, by_ratio, [](size_t, double, double) { return 1.0; }) == is(3.663573988));
        CHECK(mean_of(4, by_target, [](size_t, double P, double) { return 1 / P; }) == is(8));
        CHECK(mean_of(4, by_target, [](size_t i, double P, double) { return 1 / (p[i] * P); }) ==
              is(52));
        CHECK(mean_of(4, by_ratio, [](size_t i, double, double) { return 15 / p_hat[i]; }) ==
              is(11.2905333));
        auto W = [](size_t i, double, double sum) { return sum / (4 * p_hat[i]); };
        CHECK(mean_of(4, by_target, W) == is(12.20114435));
        CHECK(mean_of(4, by_ratio, W) == is(13));
    }

    TEST_CASE("failure: candidates none of which comes twice make 13 into 14.69 and 25.6") {
        CHECK(mean_without_replacement(1) == is(13));
        CHECK(mean_without_replacement(2) == is(7403.0 / 504));
        CHECK(mean_without_replacement(4) == is(205.0 / 8));
    }

    TEST_CASE("failure: a source or a target of 0 where there is light: missing, for every M") {
        for (size_t M : {1u, 4u}) {
            // p = 0 for the last two lights: only the first is found; p_hat = 0 for the last.
            CHECK(resampled(M, {0.5, 0.5, 1e-30, 1e-30}, {1, 2, 0, 0}).mean == is(1));
            CHECK(resampled(M, p, {1, 2, 4, 0}).mean == is(5));
        }
    }

    TEST_CASE("truth: tuples without any light count as 0; left out, they make 8 into 42") {
        const Four last = {0, 0, 0, 8};
        MeanVariance result = resampled(2, p, last);
        CHECK(result.mean == is(8));  // f of the last light
        CHECK(result.mean / (1 - 0.81) == is(42.10526315789));
    }
}

TEST_SUITE("ch12 target") {
    TEST_CASE("identity: wherever any point of a light gives something, the target is not 0") {
        for (const std::string& shape :
             {square(0, false), std::string("Shape \"disk\""), std::string("Shape \"sphere\""),
              std::string("Shape \"trianglemesh\" \"point3 P\" [-1 0 -1  1 0.2 -0.5  0 0 1]"),
              std::string("Shape \"trianglemesh\" \"integer indices\" [0 1 4 1 2 4 2 3 4 3 0 4]"
                          " \"point3 P\" [-1 1 -1  1 1 -1  1 1 1  -1 1 1  0.1 1.5 0.1]")})
            for (std::string two_sided : {"false", "true"}) {
                Scene scene = world_of("AreaLightSource \"diffuse\" \"bool twosided\" " +
                                       two_sided + " Rotate 35 1 2 3 Scale 0.3 0.3 0.3 " + shape);
                if (scene.lights.empty()) continue;
                Sampler random = random_numbers(1);
                const LightShape& shape_of_light = scene.light_shapes[0];
                int gave = 0, not_by_centre = 0;
                for (int i = 0; i < 40000; i++) {
                    Hit x{};
                    float distance = 0.1f * std::pow(1000.0f, random.u1());
                    x.p = distance * uniform_direction(random.u2());
                    x.n = x.ng = uniform_direction(random.u2());
                    LightPoint y = sample_area(scene, 0, random.u2());
                    Vec3 to_y = y.p - x.p;
                    float cos_y = -dot(to_y, y.n);
                    bool gives =
                        dot(to_y, x.n) > 0 && (scene.lights[0].two_sided ? cos_y != 0 : cos_y > 0);
                    if (!gives) continue;
                    gave++;
                    CHECK(ch12::target(ch12::light_bounds(scene, 0), x) > 0);
                    Vec3 to_centre = shape_of_light.centre - x.p;
                    not_by_centre += dot(to_centre, x.n) <= 0;
                }
                CHECK(gave > 1000);
                CHECK(not_by_centre > 100);  // where a plain cosine at the centre would be 0
            }
    }
}

TEST_SUITE("ch12 ris") {
    TEST_CASE("truth: resampling ten lights gives their sum, for every M") {
        Ring ring;
        CHECK(std::count(ring.given.begin(), ring.given.end(), 0.0) >= 1);
        for (int M : {1, 2, 3, 8, 16, 100}) {
            CAPTURE(M);
            check_bounded(irradiance(ring.scene, trace_12(ring.scene, M), 40000), ring.E, 0.015);
        }
    }

    TEST_CASE("agreement: pictures, lengths and classes of paths with chapter 11" *
              doctest::skip()) {
        for (const auto& [name, least] :
             std::vector<std::pair<std::string, int>>{{"cornell", 6},
                                                      {"cornell-spheres", 8},
                                                      {"two-lights", 4},
                                                      {"far-and-near", 2},
                                                      {"thousand-lights", 4},
                                                      {"near-light", 2},
                                                      {"horizon-sky", 2}}) {
            Scene scene = scene_from("scenes/" + name + ".pbrt", 32, 8);
            CHECK(check_classes(scene, trace_11(scene), scene, trace_12(scene), 20000) >= least);
        }
        // A bright light behind a wall, but 10 times as bright as the other one and not 10,000
        // times as in the file: there the few samples that count are too rare for 20,000 paths.
        Scene hidden = hidden_light("140 133 122");
        CHECK(check_classes(hidden, trace_11(hidden), hidden, trace_12(hidden), 40000) >= 8);
        Scene scene = scene_from("scenes/thousand-lights.pbrt", 32, 8);
        check_agreement(hold_against(film_of(scene, trace_11(scene), 256).film,
                                     film_of(scene, trace_12(scene), 64, 2).film),
                        0.02);
    }

    TEST_CASE("variance: a thousand lights: a quarter of the relMSE of chapter 11") {
        Scene scene = scene_from("scenes/thousand-lights.pbrt", 32, 8);
        double before = rel_mse(film_of(scene, trace_11(scene), 256).film);
        double now = rel_mse(film_of(scene, trace_12(scene), 128).film);
        CHECK(now < before / 4);
    }

    TEST_CASE("failure: a bright light behind a wall: resampling is worse than chapter 11") {
        Scene scene = scene_from("scenes/hidden-light.pbrt", 32, 8);
        double before = rel_mse(film_of(scene, trace_11(scene), 128).film);
        double now = rel_mse(film_of(scene, trace_12(scene), 128).film);
        CHECK(now > 2 * before);
    }
}

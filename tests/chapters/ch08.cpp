// Chapter 08: Russian roulette: the mean of chapter 07, its price, and what a wrong one does.
#include <doctest/doctest.h>

#include "chapters/07_path_tracing/estimator.h"
#include "chapters/08_russian_roulette/estimator.h"
#include "tests/support/estimators.h"
#include "tests/support/scenes.h"

namespace {

/// A path in a closed sphere that emits 1 and reflects a, drawn in proportion to the cosine (every
/// bounce is worth a): X = sum (a / q)^k over the bounces k that roulette lets live.
double furnace_path(double a, double q, Sampler& random, bool divide = true) {
    double L = 1, beta = 1;
    while (static_cast<double>(random.u1()) < q) {
        beta *= divide ? a / q : a;
        L += beta;
    }
    return L;
}

RunningStats furnace(double a, double q, int paths, bool divide = true) {
    RunningStats stats;
    Sampler random = random_numbers(1);
    for (int i = 0; i < paths; i++) stats.add(furnace_path(a, q, random, divide));
    return stats;
}

struct Moments {
    double mean, variance, kurtosis;
};
constexpr double choose[5][5] = {{1}, {1, 1}, {1, 2, 1}, {1, 3, 3, 1}, {1, 4, 6, 4, 1}};

/// m[n] = E[X^n] for n = 0 .. 4
Moments central(const double* m) {
    double variance = m[2] - m[1] * m[1];
    double fourth = m[4] - 4 * m[1] * m[3] + 6 * m[1] * m[1] * m[2] - 3 * std::pow(m[1], 4);
    return {m[1], variance, fourth / (variance * variance)};
}

/// The red channel of such a path where red, green and blue are reflected by (0.9, 0.1, 0.1), and
/// `survival` is asked as chapter 08 asks it.
template <class Survival>
RunningStats red_furnace(const Survival& survival, int paths) {
    RunningStats stats;
    Sampler random = random_numbers(1);
    for (int i = 0; i < paths; i++) {
        Rgb beta = {1, 1, 1};
        double red = 1;
        for (int depth = 0;; depth++) {
            beta *= Rgb{0.9f, 0.1f, 0.1f};
            float q = survival(beta, depth);
            if (random.u1() >= q) break;
            beta /= q;
            red += static_cast<double>(beta.r);
        }
        stats.add(red);
    }
    return stats;
}

/// The same, exactly: what survives bounce k is always worth b_k, so that what follows is
/// R_k = B_k (b_k + R_k+1), B_k = 1 with probability q_k.  E[R_k^n] = q_k E[(b_k + R_k+1)^n]
Moments red_moments() {
    std::vector<std::pair<double, double>> bounces;  // b_k, q_k
    double b = 1;
    for (int k = 0; k < 1000; k++) {
        double q = k < 3 ? 1 : std::clamp(0.9 * b, 0.05, 1.0);
        bounces.emplace_back(b *= 0.9 / q, q);
    }
    auto add = [](double x, const double* m, int n) {  // E[(x + R)^n]
        double sum = 0;
        for (int k = 0; k <= n; k++) sum += choose[n][k] * std::pow(x, n - k) * m[k];
        return sum;
    };
    double m[5] = {1, 0, 0, 0, 0};
    for (auto k = bounces.rbegin(); k != bounces.rend(); ++k)
        for (int n = 4; n >= 1; n--) m[n] = k->second * add(k->first, m, n);
    double X[5];
    for (int n = 0; n <= 4; n++) X[n] = add(1, m, n);
    return central(X);
}

Scene closed_sphere(double a, int max_depth) {
    std::string albedo = std::to_string(a) + " ";
    Scene scene = world_of(
        "ReverseOrientation AreaLightSource \"diffuse\"\n"
        "Material \"diffuse\" \"rgb reflectance\" [" +
        albedo + albedo + albedo + "] Shape \"sphere\"");
    scene.camera.o = {0, 0, 0};
    scene.max_depth = max_depth;
    return scene;
}

}  // namespace

TEST_SUITE("ch08 roulette") {
    TEST_CASE("failure: without the division by q the furnace shows 1 / (1 - a q)") {
        // 2.78 instead of 5: a smooth, converged, wrong picture.
        double p = 0.64, truth = 1 / (1 - p);
        RunningStats s = furnace(0.8, 0.8, 200000, false);
        CHECK(std::abs(s.mean() - 2.777777777778) < 5 * s.standard_error());
        CHECK(s.standard_error() < 0.01);
        CHECK(truth == doctest::Approx(2.777777777778).epsilon(1e-9).scale(0));
        CHECK(std::abs(s.mean() - 5) > 100 * s.standard_error());
    }

    TEST_CASE("identity: q is a probability, at least 0.05, and 1 for short paths") {
        Sampler random = random_numbers(1);
        for (int i = 0; i < 10000; i++) {
            float size = std::pow(10.0f, 4 * random.u1() - 3);
            Rgb beta = {size * random.u1(), size * random.u1(), size * random.u1()};
            for (int depth : {0, 1, 2}) CHECK(ch08::survival_probability(beta, depth) == 1);
            float q = ch08::survival_probability(beta, 3 + i % 50);
            CHECK(q >= 0.05f);
            CHECK(q <= 1);
            // No channel grows.
            CHECK(max_component(beta / q) <= std::max(1.0f, max_component(beta)) * 1.000001f);
        }
        CHECK(ch08::survival_probability({0, 0, 0}, 10) == 0.05f);
    }

    TEST_CASE("truth: with colours, q from the largest channel keeps the variance of red finite") {
        Moments red = red_moments();
        CHECK(red.mean == doctest::Approx(10).epsilon(1e-9).scale(0));
        // The fourth bounce survives with 0.9^4; each one after it with 0.9, and is worth 1.
        double q = std::pow(0.9, 4), variance = q * (90 + 100) - q * q * 100;
        CHECK(variance == doctest::Approx(81.612279).epsilon(1e-9).scale(0));
        CHECK(red.variance == doctest::Approx(variance).epsilon(1e-9).scale(0));
        RunningStats s = red_furnace(ch08::survival_probability, 200000);
        check_mean(s, red.mean, red.variance, 0.2);
        check_variance(s, red.variance, red.kurtosis);
    }

    TEST_CASE("teeth: q from the mean of the channels makes the red of survivors 3, not 1") {
        auto from_mean = [](Rgb beta, int depth) {
            return depth < 3 ? 1 : std::clamp(average(beta), 0.05f, 1.0f);
        };
        // After some bounces beta is nearly pure red, and its mean is a third of red.
        Rgb beta = {0.3f, 1e-4f, 1e-4f};
        CHECK((beta / from_mean(beta, 5)).r > 2.9f);
        CHECK((beta / ch08::survival_probability(beta, 5)).r == 1);
        RunningStats s = red_furnace(from_mean, 200000);
        Moments red = red_moments();
        CHECK(std::abs(s.variance() / red.variance - 1) > 5 * std::sqrt(red.kurtosis / 200000));
        CHECK(s.variance() > 2 * red.variance);  // exactly: 330.918 and 81.612
    }
}

TEST_SUITE("ch08 russian roulette") {
    TEST_CASE("truth: inside a closed sphere: Le / (1 - a)") {
        for (double a : {0.5, 0.8}) {
            Rendering r = film_of(closed_sphere(a, 100000), ch08::trace, 100);
            CHECK(r.stats.paths_cut == 0);
            CHECK(std::abs(r.film.mean() * (1 - a) - 1) < 5 * r.film.standard_error() * (1 - a));
            CHECK(r.film.standard_error() * (1 - a) < 0.01);
        }
    }

    TEST_CASE("agreement: pictures, lengths and classes of paths with chapter 07") {
        for (std::string name : {"cornell", "cornell-spheres", "color-bleeding"}) {
            CAPTURE(name);
            Scene scene = scene_from("scenes/" + name + ".pbrt", 32, 12);
            CHECK(check_classes(scene, ch07::trace, scene, ch08::trace, 60000) >= 6);
        }
        Scene scene = scene_from("scenes/color-bleeding.pbrt", 32, 12);
        Film a = film_of(scene, ch07::trace, 128).film,
             b = film_of(scene, ch08::trace, 128, 2).film;
        check_agreement(hold_against(a, b), 0.02);
    }

    TEST_CASE("variance: fewer rays for about the same error") {
        Scene scene = scene_from("scenes/cornell.pbrt", 32, 100);
        Rendering a = film_of(scene, ch07::trace, 256), b = film_of(scene, ch08::trace, 256);
        auto cost = [](const Rendering& r) {  // relative variance of the mean, times rays
            double e = r.film.standard_error() / r.film.mean();
            return e * e * static_cast<double>(r.stats.rays);
        };
        CHECK(static_cast<double>(b.stats.rays) < 0.6 * static_cast<double>(a.stats.rays));
        CHECK(cost(b) < 0.7 * cost(a));
    }

    TEST_CASE("truth: only the depth limit ends paths that lose nothing") {
        // In the middle of a cube of glass: what meets its front at more than 41.8 degrees,
        // x^2 + y^2 > 0.8, is reflected for ever.
        Scene cube = world_of(
            "LightSource \"infinite\" Material \"dielectric\" \"float eta\" 1.5\n"
            "Shape \"trianglemesh\" \"integer indices\" [0 3 1 0 2 3 4 7 6 4 5 7 0 5 4 0 1 5"
            " 2 7 3 2 6 7 0 6 2 0 4 6 1 7 5 1 3 7]\n \"point3 P\" [-1 -1 -1  1 -1 -1"
            "  -1 1 -1  1 1 -1  -1 -1 1  1 -1 1  -1 1 1  1 1 1]");
        cube.camera.o = {0, 0, 0}, cube.camera.fov = 90;
        cube.max_depth = 1000;
        Rendering r = film_of(cube, ch08::trace, 4);
        double paths = static_cast<double>(r.film.samples());
        double share = static_cast<double>(r.stats.paths_cut) / paths;
        double trapped = 1 - std::numbers::pi * 0.8 / 4;
        CHECK(std::abs(share - trapped) < 5 * std::sqrt(trapped * (1 - trapped) / paths));
    }

    TEST_CASE("identity: what roulette keeps, it hands on: --explain sees q and beta") {
        Scene scene = closed_sphere(0.5, 100);
        PathStory story(100, false);
        Recorder recorder(true, &story);
        bool seen = false;
        for (uint32_t i = 0; i < 100 && !seen; i++) {
            Sampler sampler(SamplerType::independent, 1, 1);
            sampler.start(0, i);
            recorder.start();
            ch08::trace(scene, {{0, 0, 0}, {0, 0, 1}}, sampler, recorder);
            seen = story.text().find("survives roulette, q 0.") != std::string::npos;
        }
        CHECK(seen);
    }
}

// What the program of chapter 04 shows: a table of experiments with their exact variances, and a
// picture.
#pragma once
#include <algorithm>
#include <functional>
#include <string>

#include "chapters/04_importance/estimator.h"
#include "common/base/stats.h"
#include "common/path/sampler.h"
#include "common/picture/drawing.h"
#include "common/render/options.h"

namespace ch04 {

struct Experiment {
    std::string what, density;
    double truth, mean, variance;  // exact: of the integral, and of X
    std::function<double(double u)> X;
};

inline Experiment sum_experiment(const std::string& what, const std::string& name,
                                 const std::vector<double>& f, const std::vector<double>& pmf) {
    return {what,
            name,
            exact_mean(f, std::vector<double>(f.size(), 1)),
            exact_mean(f, pmf),
            exact_variance(f, pmf),
            [=](double u) { return estimate_sum(f, pmf, u); }};
}

inline std::vector<Experiment> sums() {
    std::vector<Experiment> list;
    auto score = for_each_roll([](double a, double b) { return (6 * a + b) / 36; });
    auto add_dice = [&](const char* name, auto weight) {
        list.push_back(sum_experiment("dice 6a+b", name, score, normalized(for_each_roll(weight))));
    };
    add_dice("fair", [](double, double) { return 1; });
    add_dice("~ 6a+b, the best", [](double a, double b) { return 6 * a + b; });
    add_dice("~ a", [](double a, double) { return a; });
    add_dice("~ mean over b", [](double a, double) { return 6 * a + 3.5; });
    add_dice("~ root mean square over b",
             [](double a, double) { return std::sqrt(std::pow(6 * a + 3.5, 2) + 35.0 / 12); });
    add_dice("~ 7-a, backwards", [](double a, double) { return 7 - a; });
    add_dice("~ b, the wrong die", [](double, double b) { return b; });
    add_dice("0 for a = 1: biased", [](double a, double) { return a > 1 ? 1 : 0; });
    list.push_back(sum_experiment("lights 1, 1", "1/4, 3/4", {1, 1}, {0.25, 0.75}));
    list.push_back(sum_experiment("lights 1, 1", "1/2, 1/2", {1, 1}, {0.5, 0.5}));
    list.push_back(sum_experiment("lights 1, 3", "1/2, 1/2", {1, 3}, {0.5, 0.5}));
    list.push_back(sum_experiment("lights 1, 3", "1/4, 3/4", {1, 3}, {0.25, 0.75}));
    list.push_back(sum_experiment("lights 1, 999", "1/2, 1/2", {1, 999}, {0.5, 0.5}));
    list.push_back(sum_experiment("lights 1, 999", "0.999, 0.001", {1, 999}, {0.999, 0.001}));
    list.push_back(sum_experiment("lights 1, 999", "0, 1: biased", {1, 999}, {0, 1}));
    return list;
}

inline std::vector<Experiment> integrals() {
    std::vector<Experiment> list;
    auto add = [&](const char* what, auto f, double truth, const Density& density, double variance,
                   double mean) {
        list.push_back({what, density.name, truth, mean, variance,
                        [=](double u) { return estimate_integral(f, density, u); }});
    };
    constexpr double third = 1.0 / 3, e = std::numbers::e, p = 1 / std::numbers::pi;
    auto x2 = [](double x) { return x * x; };
    auto not_divided = [](double x) { return x * x * 2 * x; };
    auto exp = [](double x) { return std::exp(x); };
    auto root = [](double x) { return 1 / std::sqrt(x); };
    auto fourth_root = [](double x) { return std::pow(x, -0.25); };
    auto edge = [=](double x) { return x < p ? 1 : 0; };
    auto line = [](double x) { return x - 0.25; };
    add("x^2", x2, third, uniform, 4.0 / 45, third);
    add("x^2", x2, third, linear, 1.0 / 72, third);
    add("x^2", x2, third, quadratic, 0, third);
    add("x^2", x2, third, inverse_root, 25.0 / 99, third);
    add("x^2", x2, third, falling, INFINITY, third);
    add("x^2", x2, third, left_half, 1.0 / 320 - 1.0 / 576, 1.0 / 24);
    add("x^2, not divided", not_divided, third, linear, 1.0 / 12, 0.5);
    add("e^x", exp, e - 1, uniform, (e * e - 1) / 2 - (e - 1) * (e - 1), e - 1);
    add("e^x", exp, e - 1, rising, 0.0269084281835, e - 1);
    add("x^-1/2", root, 2, uniform, INFINITY, 2);
    add("x^-1/2", root, 2, inverse_root, 0, 2);
    add("x^-1/4", fourth_root, 4 * third, uniform, 2.0 / 9, 4 * third);
    add("[x < 1/pi]", edge, p, uniform, p * (1 - p), p);
    add("x - 1/4", line, 0.25, uniform, 1.0 / 12, 0.25);
    add("x - 1/4", line, 0.25, distance, 0.03515625, 0.25);
    return list;
}

struct Outcome {
    RunningStats stats;
    double largest_share = 0;  // of the largest term in sum X^2: stays high if Var X is infinite
};

inline Outcome run(const Experiment& experiment, uint64_t n, uint32_t seed) {
    Outcome outcome;
    double largest = 0, sum = 0;
    Sampler sampler(SamplerType::independent, seed, 1);
    for (uint64_t i = 0; i < n; i++) {
        sampler.start(static_cast<uint32_t>(i >> 32), static_cast<uint32_t>(i));
        double X = experiment.X(open_unit(sampler.u2()));
        outcome.stats.add(X);
        largest = std::max(largest, X * X);
        sum += X * X;
    }
    outcome.largest_share = sum > 0 ? largest / sum : 0;
    return outcome;
}

inline void add_rows(Table& table, const std::vector<Experiment>& experiments, uint64_t n,
                     uint32_t seed) {
    for (const Experiment& e : experiments) {
        double start = cpu_seconds();
        Outcome o = run(e, n, seed);
        table.rows.push_back({e.what, e.density, std::to_string(n), digits(o.stats.mean(), 6),
                              digits(n < 2 ? NAN : o.stats.standard_error(), 2),
                              digits(o.stats.mean() - e.truth, 2), digits(e.variance),
                              digits(n < 2 ? NAN : o.stats.variance()), digits(o.largest_share, 2),
                              digits(cpu_seconds() - start, 2)});
    }
}

/// All experiments with n samples each.
inline Table results_table(uint64_t n, uint32_t seed) {
    Table table{{"estimated", "density", "N", "estimate", "std error", "error", "exact var",
                 "measured", "largest", "seconds"},
                {}};
    add_rows(table, sums(), n, seed);
    add_rows(table, integrals(), n, seed);
    return table;
}

/// Six densities for x^2: the integrand (grey), the density (blue), and X = f/p where it was drawn
/// (orange). The flatter the dots, the smaller the variance; their mean is the integral (line).
inline Image densities_picture(uint32_t seed) {
    constexpr int width = 204, height = 154;
    constexpr Rgb paper{0.9f, 0.9f, 0.88f}, grey{0.6f, 0.6f, 0.58f}, blue{0.05f, 0.2f, 0.55f},
        orange{0.85f, 0.25f, 0.05f};
    Image image(3 * width - 4, 2 * height - 4);
    std::fill(image.pixels.begin(), image.pixels.end(), Rgb{1, 1, 1});
    int cell = 0;
    for (const Density& density : {uniform, linear, quadratic, inverse_root, falling, left_half}) {
        Panel panel{image,      cell % 3 * width, cell / 3 * height, width - 4,
                    height - 4, {0, 0},           {1, 2.2f}};
        panel.fill([&](Vec2 x) { return x.y < x.x * x.x ? grey : paper; });
        panel.line({0, 1.0f / 3}, {1, 1.0f / 3}, {1, 1, 1});
        panel.curve([&](float x) { return density.pdf(double{x}); }, blue);
        Sampler sampler(SamplerType::independent, seed, 1);
        for (uint32_t i = 0; i < 200; i++) {
            sampler.start(static_cast<uint32_t>(cell), i);
            double u = open_unit(sampler.u2()), x = density.sample(u);
            double X = estimate_integral([](double t) { return t * t; }, density, u);
            panel.dot({static_cast<float>(x), static_cast<float>(X)}, 1.6f, orange);
        }
        cell++;
    }
    return image;
}

}  // namespace ch04

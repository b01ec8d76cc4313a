// The random numbers of common/path/sampler.h: their bits, their evenness, and their independence.
#include "common/path/sampler.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <set>
#include <vector>

#include "chapters/03_point_sets/estimator.h"
#include "tests/support/gates.h"

namespace {

constexpr SamplerType all_types[] = {SamplerType::independent, SamplerType::stratified,
                                     SamplerType::sobol};

/// The first `n` samples of a pixel: the pair number `pair` of each.
std::vector<Vec2> pixel_points(Sampler sampler, uint32_t pixel, uint32_t n, int pair) {
    std::vector<Vec2> points;
    for (uint32_t i = 0; i < n; i++) {
        sampler.start(pixel, i);
        for (int k = 0; k < pair; k++) sampler.u2();
        points.push_back(sampler.u2());
    }
    return points;
}

/// Whether each of the 2^m boxes of size 2^-a x 2^-(m-a) holds one of the 2^m points, for every a.
bool fills_all_dyadic_boxes(const std::vector<Vec2>& points, int m) {
    for (int a = 0; a <= m; a++) {
        std::set<std::pair<int, int>> boxes;
        for (Vec2 p : points)
            boxes.emplace(static_cast<int>(std::ldexp(p.x, a)),
                          static_cast<int>(std::ldexp(p.y, m - a)));
        if (boxes.size() != points.size()) return false;
    }
    return points.size() == size_t{1} << m;
}

double chi_square_10x10(const std::vector<Vec2>& points) {
    std::array<double, 100> counts{};
    for (Vec2 p : points)
        counts[static_cast<size_t>(10 * p.x) * 10 + static_cast<size_t>(10 * p.y)]++;
    return chi_square(counts);
}

struct Rectangle {
    Vec2 low, high;
    double area() const {
        return (static_cast<double>(high.x) - static_cast<double>(low.x)) *
               (static_cast<double>(high.y) - static_cast<double>(low.y));
    }
};

/// The strata of a jitter, found by asking for their corners.
template <class Jitter>
std::vector<Rectangle> strata(Jitter jitter, uint32_t n) {
    std::vector<Rectangle> boxes;
    constexpr float almost_1 = 0x1.fffffep-1f;
    for (uint32_t i = 0; i < n; i++)
        boxes.push_back({jitter(i, n, Vec2{0, 0}), jitter(i, n, Vec2{almost_1, almost_1})});
    return boxes;
}

/// Whether the boxes cover the square once: equal areas of 1/n, and no two that overlap.
bool are_equal_tiles(const std::vector<Rectangle>& boxes) {
    constexpr float rounding = 1e-6f;
    double n = static_cast<double>(boxes.size());
    for (const Rectangle& a : boxes) {
        if (std::abs(a.area() * n - 1) > 1e-4) return false;
        for (const Rectangle& b : boxes)
            if (&a != &b && a.low.x + rounding < b.high.x && b.low.x + rounding < a.high.x &&
                a.low.y + rounding < b.high.y && b.low.y + rounding < a.high.y)
                return false;
    }
    return true;
}

}  // namespace

TEST_SUITE("sampler") {
    TEST_CASE("identity: random bits become numbers that are never 1") {
        CHECK(to_unit_float(0xffffffffu) == 0x1.fffffep-1f);
        CHECK(to_unit_float(0) == 0);
        CHECK(to_unit_float(0x100u) == 0x1p-24f);  // the smallest that is not 0
        CHECK(to_unit_double({0, 0x1p-24f}) == 0x1p-48);
        CHECK(to_unit_double({0x1.fffffep-1f, 0x1.fffffep-1f}) == 1 - 0x1p-48);
    }

    TEST_CASE("identity: Sobol's second coordinate from either end") {
        for (uint32_t k = 0; k < 32; k++)  // linear: what holds for each bit holds for all
            CHECK(sobol_second_reversed(1u << k) == reverse_bits(ch03::sobol_second(1u << k)));
    }

    TEST_CASE("density: every number is in [0,1), and as many fall into each of 10 x 10 cells") {
        // One pair per pixel: however a pixel spreads its samples, a single one is uniform.
        for (SamplerType type : all_types)
            for (uint32_t spp : {1u, 7u, 16u})
                for (int pair : {0, 1, 7, 40}) {
                    CAPTURE(pair);
                    std::vector<Vec2> points;
                    for (uint32_t pixel = 0; pixel < 100000; pixel++) {
                        Sampler sampler(type, 1, spp);
                        sampler.start(pixel, pixel % spp);
                        for (int k = 0; k < pair; k++) sampler.u2();
                        Vec2 p = sampler.u2();
                        points.push_back(p);
                        if (!(p.x >= 0 && p.x < 1 && p.y >= 0 && p.y < 1)) FAIL(p.x, " ", p.y);
                    }
                    double chi2 = chi_square_10x10(points);
                    CHECK(chi_square_tail(chi2, 99) > 1e-6);
                    CHECK(chi_square_tail(chi2, 99) <
                          1 - 1e-6);  // nor too even: pixels are independent
                }
    }

    TEST_CASE("density: neighbours in pixel, sample, dimension and seed are not correlated") {
        // 12 (u - 1/2)(v - 1/2) has mean 0 and variance 1 when u and v are independent.
        constexpr uint32_t n = 1 << 18;
        struct Number {
            uint32_t seed, pixel, dimension = 0, sample = 3;
        };
        auto number = [](SamplerType type, Number x) {
            Sampler s(type, x.seed, 16);
            s.start(x.pixel, x.sample);
            for (uint32_t d = 0; d < x.dimension; d++) s.u1();
            return double{s.u1()} - 0.5;
        };
        for (SamplerType type : all_types)
            for (auto [a, b] : {std::pair{1u, 2u}, {92u, 267u}, {1u, 0x80000001u}}) {
                RunningStats products[7];
                for (uint32_t p = 0; p < n; p++) {
                    Number others[] = {{a, p + 1},    {a, p + 256},   {a, p, 1}, {b, p},
                                       {b, p ^ 8592}, {b, p + b - a}, {b, n - p}};
                    double own = 12 * number(type, {a, p});
                    for (size_t k = 0; k < 7; k++) products[k].add(own * number(type, others[k]));
                }
                for (const RunningStats& product : products) check_mean(product, 0, 1, 0.02);
            }
        RunningStats sample;
        for (uint32_t i = 0; i < n; i++)
            sample.add(12 * number(SamplerType::independent, {1, 0, 0, i}) *
                       number(SamplerType::independent, {1, 0, 0, i + 1}));
        check_mean(sample, 0, 1, 0.02);
    }

    TEST_CASE("truth: permute is a permutation for every n, and each place equally likely") {
        for (uint32_t n = 1; n <= 200; n++)
            for (uint32_t seed : {0u, 1u, 0xffffffffu, 0x9e3779b9u}) {
                std::vector<bool> seen(n, false);
                for (uint32_t i = 0; i < n; i++) seen[permute(i, n, seed)] = true;
                CHECK(std::count(seen.begin(), seen.end(), true) == n);
            }
        for (uint32_t i = 0; i < 10; i++) {
            std::array<double, 10> counts{};
            for (uint32_t seed = 0; seed < 100000; seed++) counts[permute(i, 10, hash32(seed))]++;
            CHECK(chi_square_tail(chi_square(counts), 9) > 1e-6);
        }
    }

    TEST_CASE("identity: n strata of area 1/n tile the square for every n from 1 to 200") {
        for (uint32_t n = 1; n <= 200; n++) {
            CAPTURE(n);
            CHECK(are_equal_tiles(strata(jitter_in_stratum, n)));
        }
    }

    TEST_CASE("identity: scrambled and shuffled points fill the same boxes, in every dimension") {
        for (uint32_t pixel = 0; pixel < 50; pixel++)
            for (int pair : {0, 1, 6})
                for (int m = 1; m <= 8; m++) {
                    Sampler sampler(SamplerType::sobol, 1, 1u << m);
                    CHECK(fills_all_dyadic_boxes(pixel_points(sampler, pixel, 1u << m, pair), m));
                }
    }
}

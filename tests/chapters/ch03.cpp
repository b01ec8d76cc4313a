// Chapter 03: point sets by their exact variances, their discrepancy, and their failures; and pairs
// of dimensions.
#include <doctest/doctest.h>

#include <set>
#include <utility>

#include "chapters/03_point_sets/figure.h"
#include "tests/support/points.h"

namespace {

using ch03::PointSet;

constexpr PointSet all_sets[] = {PointSet::uniform,  PointSet::jittered, PointSet::poisson,
                                 PointSet::repelled, PointSet::halton,   PointSet::sobol};

/// The distance from each point to its nearest neighbour on the torus.
std::vector<float> nearest_distances(const Points& points) {
    std::vector<float> distances;
    for (const Vec2& a : points) {
        float nearest = infinity;
        for (const Vec2& b : points)
            if (&a != &b) {
                Vec2 d = ch03::torus_difference(a, b);
                nearest = std::min(nearest, std::hypot(d.x, d.y));
            }
        distances.push_back(nearest);
    }
    return distances;
}

/// 4 |p - centre|^2, whose average is 2/3 unless points crowd at the rim.
double rim(Vec2 p) {
    double x = double{p.x} - 0.5, y = double{p.y} - 0.5;
    return 4 * (x * x + y * y);
}

double xz(Vec2 p, Vec2 q) { return double{p.x} * double{q.x}; }

/// The mean square error of the estimate of xz, from `runs` Sobol sets and second sets.
template <class Second>
double mean_square_error(uint32_t n, uint32_t runs, Second second) {
    RunningStats squares;
    for (uint32_t run = 0; run < runs; run++) {
        uint32_t seed = hash32(run, 3);
        Points first = ch03::sobol_points(n, seed);
        squares.add(std::pow(ch03::estimate_4d(first, second(n, seed), xz) - 0.25, 2));
    }
    return squares.mean();
}

}  // namespace

TEST_SUITE("ch03 points") {
    TEST_CASE("truth: every kind of points is unbiased, for pi, for xy and for e^(x+y)") {
        for (PointSet set : all_sets)
            check_points([=](auto... n_and_seed) { return ch03::make_points(set, n_and_seed...); },
                         [](const Points& points, auto f) { return estimate(points, f); },
                         set == PointSet::repelled ? 37 : 1, set == PointSet::poisson);
    }
}

TEST_SUITE("ch03 low discrepancy") {
    TEST_CASE("truth: radical inverses") {
        float two[] = {0, 0.5f, 0.25f, 0.75f, 0.125f, 0.625f, 0.375f, 0.875f, 0.0625f};
        int three[] = {0, 9, 18, 3, 12, 21, 6, 15, 24};  // 27ths
        for (uint32_t i = 0; i < 9; i++) {
            CHECK(ch03::radical_inverse(2, i) == two[i]);
            CHECK(std::abs(ch03::radical_inverse(3, i) - static_cast<float>(three[i]) / 27) <
                  1e-7f);
        }
        CHECK(ch03::radical_inverse(2, 0xffffffffu) == 0x1.fffffep-1f);  // 1 - 2^-32 is no float

        // Scrambled, each point is uniform, the first one too.
        for (uint32_t i : {0u, 1u, 5u}) {
            double mean = 0;
            for (uint32_t seed = 1; seed <= 4000; seed++)
                mean += double{ch03::radical_inverse(3, i, seed)} / 4000;
            CHECK(std::abs(mean - 0.5) < 5 / std::sqrt(12 * 4000.0));
        }
        // And one of the first 3^3 of them lies in each 27th.
        for (uint32_t seed = 1; seed <= 20; seed++) {
            std::set<int> taken;
            for (uint32_t i = 0; i < 27; i++)
                taken.insert(static_cast<int>(27 * ch03::radical_inverse(3, i, seed)));
            CHECK(taken.size() == 27);
        }
    }

    TEST_CASE("truth: pairs of dimensions do not depend on each other, however few the points") {
        for (PointSet set :
             {PointSet::uniform, PointSet::jittered, PointSet::halton, PointSet::sobol}) {
            constexpr uint32_t runs = 20000;
            double mean = 0;
            for (uint32_t seed = 0; seed < runs; seed++)
                mean += ch03::estimate_4d(ch03::make_points(set, 4, seed),
                                          ch03::second_pair(set, 4, seed), xz) /
                        runs;
            // The standard deviation of xz is at most 7/12^2 of the root of its 4 points.
            CHECK(std::abs(mean - 0.25) < 5 * std::sqrt(7.0) / 12 / std::sqrt(double{runs}));
        }
    }

    TEST_CASE("failure: Halton in bases 17 and 19 starts on a line") {
        auto correlation = [](uint32_t n, uint32_t seed_x, uint32_t seed_y) {
            RunningStats x, y, xy;
            for (uint32_t i = 0; i < n; i++) {
                double a = double{ch03::radical_inverse(17, i, seed_x)};
                double b = double{ch03::radical_inverse(19, i, seed_y)};
                x.add(a), y.add(b), xy.add(a * b);
            }
            return (xy.mean() - x.mean() * y.mean()) / std::sqrt(x.variance() * y.variance());
        };
        CHECK(correlation(17, 0, 0) > 0.94);                    // 1 but for the divisors n and n-1
        CHECK(std::abs(correlation(289, 1, hash32(1))) < 0.3);  // scrambled: the cure
    }

    TEST_CASE("variance: Sobol points as with explicit nested scrambling, shifted Halton") {
        struct Row {
            PointSet set;
            uint32_t n;
            double pi, xy, gate;  // the table of Halton comes from shifts, too: 4 % more
        };
        for (Row row : {Row{PointSet::sobol, 16, 4.805e-2, 4.785e-5, 0.15},
                        {PointSet::sobol, 256, 7.015e-4, 1.952e-8, 0.15},
                        {PointSet::halton, 16, 5.534e-2, 5.655e-4, 0.20},
                        {PointSet::halton, 256, 8.550e-4, 4.912e-6, 0.20}}) {
            CAPTURE(row.n);
            auto by_set = [&](uint32_t seed, auto f) {
                return estimate(ch03::make_points(row.set, row.n, seed), f);
            };
            auto variance = [&](auto f) { return estimates(by_set, 3000, f).variance(); };
            CHECK(std::abs(variance(quarter_circle) / row.pi - 1) < row.gate);
            CHECK(std::abs(variance(product) / row.xy - 1) < row.gate);
        }
    }
}

TEST_SUITE("ch03 Poisson disc") {
    TEST_CASE("truth: no two points are nearer than r, across the border too") {
        RunningStats count;
        for (uint32_t seed = 0; seed < 50; seed++) {
            Points points = ch03::make_points(PointSet::poisson, 100, seed);
            count.add(static_cast<double>(points.size()));
            for (float d : nearest_distances(points)) CHECK(d * d >= 0.0065f * 0.999999f);
        }
        CHECK(std::abs(count.mean() - 97) < 3);
    }

    TEST_CASE("failure: Poisson discs on the open square crowd at its rim") {
        auto on = [](ch03::Rim where) {
            return [=](uint32_t seed, auto f) {
                return estimate(ch03::poisson_disc_points(0.1f, 1000, seed, where), f);
            };
        };
        RunningStats torus = estimates(on(ch03::Rim::torus), 100, rim);
        CHECK(std::abs(torus.mean() - 2.0 / 3) < 5 * torus.standard_error());
        CHECK(torus.mean() < 0.69);
        CHECK(estimates(on(ch03::Rim::open), 100, rim).mean() > 0.70);
        RunningStats open_pi = estimates(on(ch03::Rim::open), 100, quarter_circle);
        CHECK(std::abs(open_pi.mean() - 3.0429) < 0.05);
        CHECK(open_pi.mean() < pi_exact - 5 * open_pi.standard_error());
    }

    TEST_CASE("failure: points that repel each other become a lattice") {
        // Mean distance to the nearest neighbour, in units of the hexagonal lattice (1.0).
        auto regularity = [](PointSet set) {
            RunningStats s;
            for (uint32_t seed = 0; seed < 10; seed++) {
                Points points = ch03::make_points(set, 64, seed);
                float lattice = ch03::hexagonal_distance(static_cast<uint32_t>(points.size()));
                for (float d : nearest_distances(points)) s.add(double{d / lattice});
            }
            return s.mean();
        };
        CHECK(ch03::hexagonal_distance(100) == nearly(0.1074569931824));
        CHECK(regularity(PointSet::uniform) < 0.55);
        CHECK(regularity(PointSet::poisson) < 0.87);
        CHECK(std::abs(regularity(PointSet::repelled) - 0.916) < 0.005);  // by the size of steps
    }
}

TEST_SUITE("ch03 pairs of dimensions") {
    TEST_CASE("identity: a shuffle keeps the points, and puts each at any place equally often") {
        constexpr size_t n = 5;
        Points points;
        for (size_t i = 0; i < n; i++) points.push_back({static_cast<float>(i), 0});
        std::vector<double> counts(n * n);
        for (uint32_t seed = 0; seed < 20000; seed++) {
            Points others = ch03::shuffled(points, hash32(seed));
            std::set<float> kept;
            for (size_t i = 0; i < n; i++) {
                kept.insert(others[i].x);
                counts[i * n + static_cast<size_t>(others[i].x)]++;
            }
            REQUIRE(kept.size() == n);
        }
        CHECK(chi_square_tail(chi_square(counts), (n - 1) * (n - 1)) > 1e-6);
        CHECK(ch03::shuffled({}, 1).empty());
    }

    TEST_CASE("variance: two pairs in a random order have the variance of random matching") {
        // Of x and z in N intervals each, in a random order: Var x Var z / (N - 1), to O(1 / N^3).
        auto second = [](uint32_t n, uint32_t seed) {
            return ch03::second_pair(PointSet::sobol, n, seed);
        };
        for (uint32_t n : {16u, 64u, 256u}) {
            CAPTURE(n);
            double truth = 1.0 / 144 / (n - 1);
            // The square of a normal error has a relative variance of 2.
            double gate = 5 * std::sqrt(2.0 / 4000);
            CHECK(std::abs(mean_square_error(n, 4000, second) / truth - 1) < gate);
        }
    }

    TEST_CASE("failure: two Sobol sets in the same order have a variance of 1/248 for large N") {
        auto second = [](uint32_t n, uint32_t seed) {
            return ch03::sobol_points(n, hash32(seed, 1));
        };
        // Bit k of z is bit k of x, flipped or not, for each of the 2^(k-1) values of the bits
        // above: the sum over k of (4^-k / 4)^2 / 2^(k-1).
        for (uint32_t n : {64u, 1024u})
            CHECK(std::abs(mean_square_error(n, 2000, second) * 248 - 1) < 0.03);
    }
}

TEST_SUITE("ch03 slopes") {
    TEST_CASE(
        "variance: in one, two and four dimensions the error falls with the slope of theory") {
        auto check = [](PointSet set, const std::vector<double>& theory) {
            check_slopes([=](uint32_t n) { return ch03::measure(set, n, 400, 1); }, theory);
        };
        check(PointSet::uniform, {-0.5, -0.5, -0.5, -0.5, -0.5, -0.5});
        // The exact variances of 4 x 4 and 32 x 32 strata: -0.730.
        check(PointSet::jittered, {-0.75, -1.0, -0.73, -1.0, -0.52, -0.53});
        check(PointSet::halton, {-1.0, -1.0, -0.745, -0.835, -0.64, -0.72});
        // In two dimensions of the table in four points; smooth: -3/2 in the limit
        check(PointSet::sobol, {-1.0, -1.5, -0.74, -1.415, -0.51, -0.53});
    }
}

// What the program of chapter 02 shows: tables of errors and their slopes, and a picture.
#pragma once
#include <algorithm>
#include <string>
#include <utility>

#include "chapters/02_stratification/estimator.h"
#include "common/picture/plot.h"
#include "common/program/table.h"

namespace ch02 {

struct Kind {
    PointSet set;
    const char *name, *edge, *smooth;  // slopes of the error in theory
    uint32_t runs, largest;            // sets, and N, that it can afford
};
inline constexpr Kind kinds[] = {
    {PointSet::uniform, "uniform", "-0.50", "-0.50", 256, 1 << 16},
    {PointSet::jittered, "jittered", "-0.75", "-1.00", 256, 1 << 16},
    {PointSet::rooks, "N-rooks", "-0.50", "-0.50", 256, 1 << 16},
    {PointSet::poisson, "Poisson disc", "-0.50 at last", "-0.50 at last", 64, 1024},
    {PointSet::repelled, "repelled", "unknown", "unknown", 64, 256},
    {PointSet::halton, "Halton, shifted", "about -0.75", "about -0.84", 256, 1 << 16},
    {PointSet::sobol, "Sobol, scrambled", "-0.75", "-1.50", 256, 1 << 16},
};

struct Measurement {
    double count = 0, pi = 0;  // means over the sets
    double errors[3] = {};     // root mean square: of pi, of xy, of the penumbra
    double seconds = 0;        // for one set
};

/// Estimates from `runs` sets of about n points, against the truth.
inline Measurement measure(PointSet set, uint32_t n, uint32_t runs, uint32_t seed) {
    RunningStats count, pi_estimate, squares[3];
    Stopwatch watch;
    for (uint32_t run = 0; run < runs; run++) {
        Points points = make_points(set, n, hash32(seed, run));
        double p = (run + 0.5) / runs * (edge_a + edge_b);
        auto seen = [&](Vec2 u) { return sees_light(u, p); };
        count.add(static_cast<double>(points.size()));
        pi_estimate.add(estimate(points, quarter_circle));
        squares[0].add(std::pow(estimate(points, quarter_circle) - std::numbers::pi, 2));
        squares[1].add(std::pow(estimate(points, product) - 0.25, 2));
        squares[2].add(std::pow(estimate(points, seen) - fraction_seen(p), 2));
    }
    auto root_mean = [&](int k) { return std::sqrt(squares[k].mean()); };
    return {count.mean(),
            pi_estimate.mean(),
            {root_mean(0), root_mean(1), root_mean(2)},
            watch.seconds() / runs};
}

/// Every kind of points with N = 16, 64, 256, ... up to n, and its efficiency for pi,
/// 1 / (relative error^2 seconds); and the slopes of the errors.
inline std::pair<Table, Table> compare_sets(uint64_t n, uint32_t seed) {
    Table errors{
        {"points", "N", "pi", "error of pi", "of xy", "of penumbra", "seconds", "efficiency"}, {}};
    Table slopes{{"slope of the error", "pi, penumbra", "theory", "xy", "theory"}, {}};
    for (const Kind& kind : kinds) {
        std::vector<double> counts, edge, smooth;
        for (uint32_t N = 16; N <= std::min<uint64_t>(n, kind.largest); N *= 4) {
            Measurement m = measure(kind.set, N, kind.runs, seed);
            errors.rows.push_back({kind.name, digits(m.count, 4), digits(m.pi),
                                   digits(m.errors[0], 3), digits(m.errors[1], 3),
                                   digits(m.errors[2], 3), digits(m.seconds, 2),
                                   digits(std::pow(m.pi / m.errors[0], 2) / m.seconds, 2)});
            counts.push_back(m.count);
            edge.push_back(std::sqrt(m.errors[0] * m.errors[2]));
            smooth.push_back(m.errors[1]);
        }
        slopes.rows.push_back({kind.name, digits(fitted_slope(counts, edge), 2), kind.edge,
                               digits(fitted_slope(counts, smooth), 2), kind.smooth});
    }
    return {errors, slopes};
}

/// 36 darts, thrown freely and into 6 x 6 strata.
inline std::string six_by_six(uint32_t seed) {
    double uniform = measure(PointSet::uniform, 36, 10000, seed).errors[0];
    double jittered = measure(PointSet::jittered, 36, 10000, seed).errors[0];
    return "\n36 darts: standard error " + digits(uniform, 3) + " uniform (exact 0.274), " +
           digits(jittered, 3) + " in 6 x 6 strata (exact 0.127); ratio of variances " +
           digits(uniform * uniform / (jittered * jittered), 3) + " (exact 4.62)\n";
}

/// A column for each kind: 64 points; the penumbra and a zone plate with 16 points in each pixel.
inline Image sets_picture(uint32_t seed) {
    constexpr int size = 76, gap = 4, sets = 256;
    constexpr Rgb white{1, 1, 1}, paper{0.85f, 0.85f, 0.82f}, ink{0.05f, 0.2f, 0.55f};
    Image image(std::ssize(kinds) * (size + gap) - gap, 2 * (size + gap) + size / 3);
    std::fill(image.pixels.begin(), image.pixels.end(), paper);
    for (int k = 0; k < std::ssize(kinds); k++) {
        int left = k * (size + gap);
        Panel panel{image, left, 0, size, size};
        for (Vec2 p : make_points(kinds[k].set, 64, seed)) panel.dot(p, 1.6f, ink);

        std::vector<Points> pool;
        for (uint32_t i = 0; i < sets; i++)
            pool.push_back(make_points(kinds[k].set, 16, hash32(seed, i)));
        uint32_t pixel = 0;  // each takes one set of the pool, by chance
        auto average = [&](auto f) {
            double value = estimate(pool[hash32(pixel++, seed) % sets], f);
            return static_cast<float>(value) * white;
        };
        Panel penumbra{image, left, size + gap, size, size / 3, {0, 0}, {1.4f, 1}};
        penumbra.fill(
            [&](Vec2 x) { return average([&](Vec2 u) { return sees_light(u, double{x.x}); }); });
        Panel zone_plate{image, left, size + size / 3 + 2 * gap, size, size, {0, 0}, {size, size}};
        zone_plate.fill([&](Vec2 x) {  // rings whose period shrinks to one pixel at the border
            return average([&](Vec2 u) {
                double i = double{x.x} + double{u.x}, j = double{x.y} + double{u.y};
                return std::cos(std::numbers::pi / size * (i * i + j * j)) > 0 ? 1 : 0;
            });
        });
    }
    return image;
}

}  // namespace ch02

// What the program of chapter 02 shows: tables of errors and their slopes, and a picture.
#pragma once
#include <algorithm>
#include <string>
#include <utility>

#include "chapters/02_stratification/estimator.h"
#include "common/picture/drawing.h"
#include "common/render/options.h"

namespace ch02 {

struct Kind {
    PointSet set;
    const char *name, *edge, *smooth;  // expected slopes of the errors
};
inline constexpr Kind kinds[] = {
    {PointSet::uniform, "uniform", "-0.50", "-0.50"},
    {PointSet::jittered, "jittered", "-0.75", "-1.00"},
    {PointSet::rooks, "N-rooks", "-0.50", "-0.50"},
};

struct Measurement {
    double pi = 0;          // mean over the sets
    double errors[3] = {};  // root mean square: of pi, of xy, of the penumbra
    double seconds = 0;     // for one set
};

/// The errors of the estimates from `runs` sets of n points.
inline Measurement measure(PointSet set, uint32_t n, uint32_t runs, uint32_t seed) {
    RunningStats pi_estimate, squares[3];
    double start = cpu_seconds();
    for (uint32_t run = 0; run < runs; run++) {
        Points points = make_points(set, n, hash32(seed, run));
        double p = (run + 0.5) / runs * (edge_a + edge_b);
        auto seen = [&](Vec2 u) { return sees_light(u, p); };
        pi_estimate.add(ch02::estimate(points, quarter_circle));
        squares[0].add(std::pow(ch02::estimate(points, quarter_circle) - std::numbers::pi, 2));
        squares[1].add(std::pow(ch02::estimate(points, product) - 0.25, 2));
        squares[2].add(std::pow(ch02::estimate(points, seen) - fraction_seen(p), 2));
    }
    auto root_mean = [&](int k) { return std::sqrt(squares[k].mean()); };
    return {pi_estimate.mean(),
            {root_mean(0), root_mean(1), root_mean(2)},
            (cpu_seconds() - start) / runs};
}

/// Every kind of points with N = 16, 64, 256, ... up to n, and its efficiency for pi,
/// 1 / (relative error^2 seconds); and the slopes of the errors.
inline std::pair<Table, Table> compare_sets(uint64_t n, uint32_t seed) {
    Table errors{
        {"points", "N", "pi", "error of pi", "of xy", "of penumbra", "seconds", "efficiency"}, {}};
    Table slopes{{"slope of the error", "pi, penumbra", "theory", "xy", "theory"}, {}};
    for (const Kind& kind : kinds) {
        std::vector<double> counts, edge, smooth;
        for (uint32_t N = 16; N <= std::min<uint64_t>(n, 1 << 16); N *= 4) {
            Measurement m = measure(kind.set, N, 256, seed);
            errors.rows.push_back({kind.name, digits(N), digits(m.pi), digits(m.errors[0], 3),
                                   digits(m.errors[1], 3), digits(m.errors[2], 3),
                                   digits(m.seconds, 2),
                                   digits(std::pow(m.pi / m.errors[0], 2) / m.seconds, 2)});
            counts.push_back(N);
            edge.push_back(std::sqrt(m.errors[0] * m.errors[2]));
            smooth.push_back(m.errors[1]);
        }
        slopes.rows.push_back({kind.name, digits(fitted_slope(counts, edge), 2), kind.edge,
                               digits(fitted_slope(counts, smooth), 2), kind.smooth});
    }
    return {errors, slopes};
}

/// 36 darts, random and in 6 x 6 strata; and 23 darts, which no square grid has.
inline std::string six_by_six(uint32_t seed) {
    double uniform = measure(PointSet::uniform, 36, 10000, seed).errors[0];
    double jittered = measure(PointSet::jittered, 36, 10000, seed).errors[0];
    double any = measure(PointSet::jittered, 23, 10000, seed).errors[0];
    return "\n36 darts: standard error " + digits(uniform, 3) + " uniform (exact 0.274), " +
           digits(jittered, 3) + " in 6 x 6 strata (exact 0.127); ratio of variances " +
           digits(uniform * uniform / (jittered * jittered), 3) +
           " (exact 4.62)\n23 darts: standard error " + digits(any, 3) +
           " in 23 strata (uniform 0.342)\n";
}

/// The strata of one kind of n points, as lines.
inline void draw_strata(const Panel& panel, PointSet set, uint32_t n, Rgb color) {
    if (set == PointSet::uniform) return;
    for (uint32_t i = 0; i < n; i++) {
        Vec2 low = ch02::jitter_in_stratum(i, n, {0, 0});
        Vec2 high = ch02::jitter_in_stratum(i, n, {1, 1});
        if (set == PointSet::rooks) {  // column i and row i, all the way
            float x = jitter_in_interval(i, n, 0);
            panel.line({x, 0}, {x, 1}, color);
            panel.line({0, x}, {1, x}, color);
        } else {
            panel.line(low, {low.x, high.y}, color);
            panel.line(low, {high.x, low.y}, color);
        }
    }
}

/// A column for each kind: 36 points, 23 points, and the penumbra with 16 points for each pixel.
inline Image sets_picture(uint32_t seed) {
    constexpr int size = 151, gap = 6;
    constexpr Rgb paper{0.85f, 0.85f, 0.82f}, lines{0.6f, 0.6f, 0.58f}, ink{0.05f, 0.2f, 0.55f};
    Image image(std::ssize(kinds) * (size + gap) - gap, 2 * (size + gap) + size / 3);
    std::fill(image.pixels.begin(), image.pixels.end(), paper);
    for (int k = 0; k < std::ssize(kinds); k++) {
        int left = k * (size + gap), top = 0;
        for (uint32_t n : {36u, 23u}) {
            Panel panel{image, left, top, size, size};
            draw_strata(panel, kinds[k].set, n, lines);
            for (Vec2 p : make_points(kinds[k].set, n, seed)) panel.dot(p, 2.6f, ink);
            top += size + gap;
        }
        Panel penumbra{image, left, top, size, size / 3, {0, 0}, {1.4f, 1}};
        uint32_t pixel = 0;
        penumbra.fill([&](Vec2 x) {
            Points points = make_points(kinds[k].set, 16, hash32(seed, pixel++));
            auto seen = [&](Vec2 u) { return sees_light(u, double{x.x}); };
            return static_cast<float>(ch02::estimate(points, seen)) * Rgb{1, 1, 1};
        });
    }
    return image;
}

}  // namespace ch02

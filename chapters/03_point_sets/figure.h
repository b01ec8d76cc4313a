// What the program of chapter 03 shows: tables of errors and their slopes, and a picture.
#pragma once
#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "chapters/03_point_sets/estimator.h"
#include "common/picture/drawing.h"
#include "common/render/options.h"

namespace ch03 {

/// What is integrated: a jump and a smooth function in 1, 2 and 4 dimensions.
struct Integrand {
    const char* name;
    double (*f)(Vec2 xy, Vec2 zw);
    double truth;
};
inline double squares(Vec2 p) { return double{p.x} * double{p.x} + double{p.y} * double{p.y}; }
inline constexpr double pi = std::numbers::pi;
inline constexpr std::array<Integrand, 6> integrands = {{
    {"1-D edge", [](Vec2 p, Vec2) { return 3 * double{p.x} < 1 ? 1.0 : 0.0; }, 1.0 / 3},
    {"1-D smooth", [](Vec2 p, Vec2) { return double{p.x}; }, 0.5},
    {"2-D edge", [](Vec2 p, Vec2) { return quarter_circle(p); }, pi},
    {"2-D smooth", [](Vec2 p, Vec2) { return product(p); }, 0.25},
    {"4-D edge", [](Vec2 p, Vec2 q) { return squares(p) + squares(q) <= 1 ? 1.0 : 0.0; },
     pi* pi / 32},
    {"4-D smooth", [](Vec2 p, Vec2 q) { return product(p) * product(q); }, 1.0 / 16},
}};

struct Kind {
    PointSet set;
    const char* name;
    std::array<const char*, 6> theory;  // slopes of the errors; "": not known
    uint32_t runs, largest;             // number of sets, and N, limited by run time
};
inline constexpr const char *half = "-0.50", *most = "-0.75", *one = "-1.00", *best = "-1.50";
inline constexpr Kind kinds[] = {
    {PointSet::uniform, "uniform", {half, half, half, half, half, half}, 256, 1 << 16},
    {PointSet::jittered, "jittered", {most, one, most, one, half, half}, 256, 1 << 16},
    {PointSet::poisson, "Poisson disc", {"", "", "", "", half, half}, 32, 1024},
    {PointSet::repelled, "repelled", {"", "", "", "", half, half}, 32, 256},
    {PointSet::halton, "Halton, shifted", {one, one, "", "", "", ""}, 256, 1 << 16},
    {PointSet::sobol, "Sobol, scrambled", {one, best, most, best, half, half}, 256, 1 << 16},
};

struct Measurement {
    double count = 0, pi = 0;           // means over the sets
    std::array<double, 6> errors = {};  // root mean square, of each integrand
    double seconds = 0;                 // for one set in two dimensions, and its estimate of pi
};

/// The errors of the estimates from `runs` sets of about n points.
inline Measurement measure(PointSet set, uint32_t n, uint32_t runs, uint32_t seed) {
    RunningStats count, pi_estimate;
    std::array<RunningStats, 6> squared_errors;
    std::vector<Points> sets;
    double start = cpu_seconds();
    for (uint32_t run = 0; run < runs; run++) {
        sets.push_back(make_points(set, n, hash32(seed, run)));
        count.add(static_cast<double>(sets.back().size()));
        pi_estimate.add(estimate(sets.back(), quarter_circle));
    }
    Measurement m{count.mean(), pi_estimate.mean(), {}, (cpu_seconds() - start) / runs};
    for (uint32_t run = 0; run < runs; run++) {
        Points second = second_pair(set, n, hash32(seed, run));
        for (size_t k = 0; k < integrands.size(); k++) {
            const Integrand& integrand = integrands[k];
            double x = estimate_4d(sets[run], k < 4 ? sets[run] : second, integrand.f);
            squared_errors[k].add((x - integrand.truth) * (x - integrand.truth));
        }
    }
    for (size_t k = 0; k < m.errors.size(); k++) m.errors[k] = std::sqrt(squared_errors[k].mean());
    return m;
}

/// Every kind of points with N = 16, 64, 256, ... up to n, and its efficiency for pi,
/// 1 / (relative error^2 seconds); and the slopes of the errors.
inline std::pair<Table, Table> compare_sets(uint64_t n, uint32_t seed) {
    Table errors{{"points", "N", "pi", "error of pi", "of xy", "of xyzw", "seconds", "efficiency"},
                 {}};
    Table slopes{{"slope (theory)"}, {}};
    for (const Integrand& integrand : integrands) slopes.columns.push_back(integrand.name);
    for (const Kind& kind : kinds) {
        std::vector<double> counts;
        std::array<std::vector<double>, 6> measured;
        for (uint32_t N = 16; N <= std::min<uint64_t>(n, kind.largest); N *= 4) {
            Measurement m = measure(kind.set, N, kind.runs, seed);
            errors.rows.push_back({kind.name, digits(m.count, 4), digits(m.pi),
                                   digits(m.errors[2], 3), digits(m.errors[3], 3),
                                   digits(m.errors[5], 3), digits(m.seconds, 2),
                                   digits(std::pow(m.pi / m.errors[2], 2) / m.seconds, 2)});
            counts.push_back(m.count);
            for (size_t k = 0; k < measured.size(); k++) measured[k].push_back(m.errors[k]);
        }
        std::vector<std::string> row = {kind.name};
        for (size_t k = 0; k < measured.size(); k++) {
            std::string theory = kind.theory[k],
                        slope = digits(fitted_slope(counts, measured[k]), 2);
            row.push_back(slope + (theory.empty() ? "" : " (" + theory + ")"));
        }
        slopes.rows.push_back(row);
    }
    return {errors, slopes};
}

/// The error of xz: x is a coordinate of one Sobol point and z of another.
inline Table compare_pairs(uint32_t seed) {
    Table table{{"error of xz", "N = 16", "64", "256", "1024", "slope"}, {}};
    auto add = [&](const char* name, auto second) {
        std::vector<double> counts, errors;
        std::vector<std::string> row = {name};
        for (uint32_t n = 16; n <= 1024; n *= 4) {
            RunningStats squared_errors;
            for (uint32_t run = 0; run < 1000; run++) {
                uint32_t set_seed = hash32(seed, run);
                Points first = sobol_points(n, set_seed);
                auto xz = [](Vec2 p, Vec2 q) { return double{p.x} * double{q.x}; };
                double error = estimate_4d(first, second(first, set_seed), xz) - 0.25;
                squared_errors.add(error * error);
            }
            counts.push_back(n);
            errors.push_back(std::sqrt(squared_errors.mean()));
            row.push_back(digits(errors.back(), 3));
        }
        row.push_back(digits(fitted_slope(counts, errors), 2));
        table.rows.push_back(row);
    };
    add("the same points again", [](const Points& p, uint32_t) { return p; });
    add("another set, same order", [](const Points& p, uint32_t set_seed) {
        return sobol_points(static_cast<uint32_t>(p.size()), hash32(set_seed, 1));
    });
    add("another set, shuffled", [](const Points& p, uint32_t set_seed) {
        return second_pair(PointSet::sobol, static_cast<uint32_t>(p.size()), set_seed);
    });
    add("x and z are one pair", [](const Points& p, uint32_t) {
        Points swapped;
        for (Vec2 q : p) swapped.push_back({q.y, q.x});
        return swapped;
    });
    return table;
}

/// A column for each kind: 64 points, and a zone plate with 16 points in each pixel.
inline Image sets_picture(uint32_t seed) {
    constexpr int size = 128, gap = 6, sets = 256;
    constexpr Rgb white{1, 1, 1}, paper{0.85f, 0.85f, 0.82f}, ink{0.05f, 0.2f, 0.55f};
    Image image(std::ssize(kinds) * (size + gap) - gap, 2 * size + gap);
    std::fill(image.pixels.begin(), image.pixels.end(), paper);
    for (int k = 0; k < std::ssize(kinds); k++) {
        int left = k * (size + gap);
        Panel panel{image, left, 0, size, size};
        for (Vec2 p : make_points(kinds[k].set, 64, seed)) panel.dot(p, 2.4f, ink);

        std::vector<Points> pool;
        for (uint32_t i = 0; i < sets; i++)
            pool.push_back(make_points(kinds[k].set, 16, hash32(seed, i)));
        uint32_t pixel = 0;  // each uses a random set of the pool
        Panel zone_plate{image, left, size + gap, size, size, {0, 0}, {size, size}};
        zone_plate.fill([&](Vec2 x) {  // rings whose period shrinks to one pixel at the border
            auto ring = [&](Vec2 u) {
                double i = double{x.x} + double{u.x}, j = double{x.y} + double{u.y};
                return std::cos(pi / size * (i * i + j * j)) > 0 ? 1 : 0;
            };
            const Points& points = pool[hash32(pixel++, seed) % sets];
            return static_cast<float>(estimate(points, ring)) * white;
        });
    }
    return image;
}

}  // namespace ch03

// What the program of chapter 01 shows: the table, the notes below it, and the picture.
#pragma once
#include <algorithm>
#include <string>

#include "chapters/01_monte_carlo_pi/estimator.h"
#include "common/picture/drawing.h"
#include "common/render/options.h"

namespace ch01 {

/// Rows for N = 1, 4, 16, ... darts of one run; the last is n.
inline Table darts_table(uint64_t n, uint32_t seed) {
    Table table{{"N", "estimate", "std error", "measured", "error", "seconds"}, {}};
    RunningStats stats;
    double seconds = 0;
    for (uint64_t rows = 1; stats.count() < n; rows *= 4) {
        uint64_t N = std::min(n, rows);
        double start = cpu_seconds();
        stats.merge(throw_darts(score_dart, stats.count(), N, seed));
        seconds += cpu_seconds() - start;
        // If all darts are equal, the estimated error is 0, but the true error is unknown.
        bool known = stats.variance() > 0, cheap = N <= 1 << 16;
        table.rows.push_back(
            {std::to_string(N), digits(stats.mean(), 7),
             digits(known ? stats.standard_error() : NAN, 3),
             cheap ? digits(measured_standard_error(score_dart, N, 64, seed), 3) : "-",
             digits(stats.mean() - std::numbers::pi, 3), digits(seconds, 2)});
    }
    return table;
}

/// The average score of the dart board, and the float sum that stops growing.
inline std::string darts_notes(uint64_t n, uint32_t seed) {
    auto score_u = [](Vec2 u) { return score_board(sample_hit(u)); };
    auto place_u = [](Vec2 u) { return static_cast<double>(sample_hit(u).x); };
    RunningStats score = throw_darts(score_u, 0, n, seed), place = throw_darts(place_u, 0, n, seed);
    uint64_t hits = 20000000;
    return "dart board: average score " + digits(score.mean()) + " +- " +
           digits(score.standard_error(), 2) + ", exact " + digits(expected_score()) +
           "; average place " + digits(place.mean(), 2) + ", which is no score\n" +
           "counted in float: " + std::to_string(hits) + " hits are " +
           digits(static_cast<double>(sum_in_float(1, hits)), 8) + "\n";
}

/// Left: the darts. Right: the running estimates of 8 runs against log N, and pi +- 1 and 2
/// standard errors.
inline Image darts_picture(uint64_t n, uint32_t seed) {
    constexpr int size = 360;
    constexpr Rgb paper{0.9f, 0.9f, 0.88f}, inside{0.85f, 0.25f, 0.05f},
        outside{0.05f, 0.2f, 0.55f};
    Image image(2 * size, size);
    Panel darts{image, 0, 0, size, size};
    darts.fill([&](Vec2 x) { return score_dart(x) > 0 ? paper : 0.8f * paper; });
    Sampler sampler(SamplerType::independent, seed, 1);
    for (uint32_t i = 0; i < std::min<uint64_t>(n, 2000); i++) {
        sampler.start(0, i);
        Vec2 x = sampler.u2();
        darts.dot(x, 1.6f, score_dart(x) > 0 ? inside : outside);
    }

    Panel runs{image, size, 0, size, size, {4, 2.3f}, {16, 4}};  // x: log2 N
    runs.fill([&](Vec2) { return paper; });
    for (uint32_t run = 0; run < 8; run++) {
        RunningStats stats;
        Vec2 last = {0, 0};
        for (float x = 3; x < runs.high.x; x += 0.02f) {
            uint64_t next = static_cast<uint64_t>(std::exp2(x));
            stats.merge(throw_darts(score_dart, stats.count(), next, hash32(seed, run)));
            Vec2 point = {x, static_cast<float>(stats.mean())};
            if (x > runs.low.x) runs.line(last, point, outside);
            last = point;
        }
    }
    for (double k : {-2, -1, 0, 1, 2})
        runs.curve([&](float x) { return std::numbers::pi + k * 1.642 * std::exp2(-x / 2); },
                   inside);
    return image;
}

}  // namespace ch01

#include "tests/measure/points.h"

#include <cstdio>

#include "chapters/01_monte_carlo_pi/estimator.h"
#include "chapters/02_stratification/figure.h"
#include "chapters/03_point_sets/figure.h"
#include "chapters/04_importance/figure.h"
#include "tests/measure/measure.h"

namespace {

constexpr const char* colors[] = {"#888888", "#1f77b4", "#2ca02c", "#ff7f0e", "#8c564b",
                                  "#9467bd", "#d62728", "#17becf", "#000000"};

const std::string samples = "samples N", seconds = "seconds of one estimate", error = "RMS error",
                  standard = "in standard deviations of one sample";

void write(const std::string& folder, const std::string& name, const std::string& title,
           const std::vector<LinePanel>& panels, int columns) {
    write_table(folder, "chart-" + name, points_table(panels));
    draw_panels(folder + "/chart-" + name, title, panels, columns);
}

/// Chapter 01: the error of `runs` experiments, beside sigma / sqrt(N).
std::vector<LinePanel> darts(uint32_t largest, uint32_t runs) {
    LinePanel over_n{"error over samples", samples, error, {}},
        over_t{"over time", seconds, error, {}};
    auto add = [&](const std::string& label, const char* color, auto score, double sigma) {
        Line by_n{label, color, "-0.50", {}, {}}, by_t = by_n, exact = by_n;
        for (uint32_t n = 4; n <= largest; n *= 4) {
            Stopwatch watch;
            by_n.x.push_back(n);
            by_n.y.push_back(ch01::measured_standard_error(score, n, runs, n));
            by_t.x.push_back(watch.seconds() / runs);
            by_t.y.push_back(by_n.y.back());
            exact.y.push_back(sigma / std::sqrt(n));
        }
        exact.x = by_n.x;
        exact.label = label + ", exact";
        exact.color = "#000000";
        over_n.lines.insert(over_n.lines.end(), {by_n, exact});
        exact.x = by_t.x;
        over_t.lines.insert(over_t.lines.end(), {by_t, exact});
    };
    add("pi by darts", colors[1], ch01::score_dart, std::sqrt(2.69676621327));
    auto board = [](Vec2 u) { return ch01::score_board(ch01::sample_hit(u)); };
    double mean = ch01::expected_score(), squares = 0, outside = 1;
    for (ch01::Ring ring : ch01::board) {
        double beyond = std::exp(-ring.radius * ring.radius / (2 * ch01::sigma * ch01::sigma));
        squares += ring.score * ring.score * (outside - beyond);
        outside = beyond;
    }
    add("score of the board", colors[3], board, std::sqrt(squares - mean * mean));
    return {over_n, over_t};
}

/// Chapter 02: random points and strata on an edge, a smooth function and a penumbra.
std::vector<LinePanel> strata(uint32_t largest, uint32_t runs) {
    std::vector<LinePanel> panels;
    for (const std::string& axis : {samples, seconds})
        for (const char* what : {"pi: an edge", "xy: smooth", "penumbra"})
            panels.push_back({what, axis, error, {}});
    size_t color = 0;
    for (const ch02::Kind& kind : ch02::kinds) {
        for (size_t p = 0; p < panels.size(); p++) {
            panels[p].lines.push_back(
                {kind.name, colors[color], p % 3 == 1 ? kind.smooth : kind.edge, {}, {}});
        }
        color++;
        for (uint32_t n = 4; n <= largest; n *= 4) {
            ch02::Measurement m = ch02::measure(kind.set, n, runs, n);
            for (size_t p = 0; p < panels.size(); p++) {
                panels[p].lines.back().x.push_back(p < 3 ? n : m.seconds);
                panels[p].lines.back().y.push_back(m.errors[p % 3]);
            }
        }
    }
    return panels;
}

/// Chapter 03: every kind of point set on edges and smooth functions in 1, 2 and 4 dimensions; over
/// time those that one set is enough for.
std::vector<LinePanel> point_sets(uint32_t largest, uint32_t runs) {
    constexpr size_t integrand_of[] = {0, 1, 2, 3, 4, 5, 1, 2, 3}, over_n = 6;
    std::vector<LinePanel> panels;
    for (size_t k : integrand_of)
        panels.push_back(
            {ch03::integrands[k].name, panels.size() < over_n ? samples : seconds, error, {}});
    size_t color = 0;
    for (const ch03::Kind& kind : ch03::kinds) {
        for (size_t p = 0; p < panels.size(); p++)
            panels[p].lines.push_back(
                {kind.name, colors[color], kind.theory[integrand_of[p]], {}, {}});
        color++;
        for (uint32_t n = 4; n <= std::min(largest, kind.largest); n *= 4) {
            ch03::Measurement m = ch03::measure(kind.set, n, std::min(runs, kind.runs), n);
            for (size_t p = 0; p < panels.size(); p++) {
                panels[p].lines.back().x.push_back(p < over_n ? m.count : m.seconds);
                panels[p].lines.back().y.push_back(m.errors[integrand_of[p]]);
            }
        }
    }
    return panels;
}

/// Chapter 04: x^2 by every density. One that is zero where x^2 is not stays at its bias.
std::vector<LinePanel> densities(uint32_t largest, uint32_t runs) {
    LinePanel over_n{"error over samples", samples, error, {}},
        over_t{"over time", seconds, error, {}};
    size_t color = 0;
    for (const ch04::Experiment& e : ch04::integrals()) {
        if (e.what != "x^2" && e.what != "x^2, not divided") continue;
        bool biased = e.mean != e.truth, exact = e.variance == 0;
        std::string note = biased                   ? ", biased"
                           : std::isinf(e.variance) ? ", infinite variance"
                                                    : "";
        if (exact) continue;  // nothing to draw: every sample is the integral
        Line by_n{(e.what == "x^2" ? "by " : "not divided by ") + e.density + note,
                  colors[color++],
                  biased ? "0" : "-0.50",
                  {},
                  {}};
        Line by_t = by_n;
        for (uint32_t n = 4; n <= largest; n *= 4) {
            RunningStats squares;
            Stopwatch watch;
            for (uint32_t run = 0; run < runs; run++) {
                double mean = ch04::run(e, n, hash32(n, run)).stats.mean();
                squares.add((mean - e.truth) * (mean - e.truth));
            }
            by_n.x.push_back(n);
            by_t.x.push_back(watch.seconds() / runs);
            by_n.y.push_back(std::sqrt(squares.mean()));
            by_t.y.push_back(by_n.y.back());
        }
        over_n.lines.push_back(by_n);
        over_t.lines.push_back(by_t);
    }
    return {over_n, over_t};
}

}  // namespace

void chart_points(const std::string& folder, uint32_t largest, uint32_t runs) {
    std::vector<LinePanel> panels = darts(largest, runs);
    write(folder, "01-darts", "Four times the darts, half the error", panels, 2);
    std::printf("chapter 01\n%s\n", markdown(slopes_table({panels[0]})).c_str());
    panels = strata(largest, runs);
    write(folder, "02-strata", "Strata lower the error most where the integrand is smooth", panels,
          3);
    panels.resize(3);
    std::printf("chapter 02\n%s\n", markdown(slopes_table(panels)).c_str());
    panels = point_sets(largest, runs);
    write(folder, "03-points", "Even points help less in four dimensions than in two", panels, 3);
    panels.resize(6);
    std::printf("chapter 03\n%s\n", markdown(slopes_table(panels)).c_str());
    panels = densities(largest, runs);
    write(folder, "04-densities",
          "A density like x^2 errs least; one that leaves part of it out stays wrong", panels, 2);
    std::printf("chapter 04\n%s\n", markdown(slopes_table({panels[0]})).c_str());
}

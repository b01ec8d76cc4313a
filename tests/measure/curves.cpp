#include "tests/measure/curves.h"

#include <algorithm>
#include <cmath>

#include "common/picture/comparison.h"
#include "tests/measure/gnuplot.h"

double root_mean_square(const std::vector<double>& values) {
    RunningStats squares;
    for (double x : values) squares.add(x * x);
    return std::sqrt(squares.mean());
}

double mean_of(const std::vector<double>& values) {
    RunningStats mean;
    for (double x : values) mean.add(x);
    return mean.mean();
}

double Curve::cost() const {
    return points.empty() ? NAN : mean_of(points.back().rel_mse) * points.back().seconds;
}

/// Of log RMSE over log samples, from the last three points; NaN for one.
static double last_slope(const std::vector<CurvePoint>& points) {
    std::vector<double> spp, rmse;
    for (size_t i = points.size() - std::min<size_t>(3, points.size()); i < points.size(); i++) {
        spp.push_back(points[i].spp);
        rmse.push_back(root_mean_square(points[i].rmse));
    }
    return fitted_slope(spp, rmse);
}

Curve measure_curve(const Method& method, Scene& scene, const Reference& reference,
                    const MeasureOptions& o, double seconds) {
    Curve curve{&method, {}, NAN};
    double spent = 0, next = 0;
    // What is biased gets longer, until chance is small beside its bias.
    auto time_left = [&] {
        return spent + next < (method.biased && !curve.flat() ? 16 * seconds : seconds);
    };
    for (int spp = 1; spp <= 1 << 20 && (spp <= 16 || time_left()); spp *= 4) {
        CurvePoint point{spp, 0, {}, {}};
        for (int run = 0; run < o.runs; run++) {
            uint32_t seed = 0x10000u * static_cast<uint32_t>(run + 1) + static_cast<uint32_t>(spp);
            Rendering r = render_once(method, scene, o, spp, seed);
            Comparison c = compare(r.film.image(), reference.image);
            point.rmse.push_back(c.rmse);
            point.rel_mse.push_back(c.rel_mse);
            point.seconds += r.stats.seconds / o.runs;
        }
        double cost = point.seconds * o.runs * o.threads;
        spent += cost;
        next = 4 * cost;
        if (!method.biased && root_mean_square(point.rmse) < 10 * reference.rmse) break;
        curve.points.push_back(point);
        curve.slope = last_slope(curve.points);
    }
    return curve;
}

namespace {

/// One row for each point: seconds, then the error in the middle, at least, at most.
template <class Middle>
std::vector<std::vector<double>> rows_of(const Curve& curve, std::vector<double> CurvePoint::*error,
                                         Middle middle) {
    std::vector<std::vector<double>> rows;
    for (const CurvePoint& p : curve.points) {
        auto [low, high] = std::minmax_element((p.*error).begin(), (p.*error).end());
        rows.push_back({p.seconds, middle(p.*error), *low, *high});
    }
    return rows;
}

std::string plot_commands(const std::vector<Curve>& curves, const std::string& kind, bool titles) {
    std::string plot = "plot ";
    for (size_t i = 0; i < curves.size(); i++) {
        if (curves[i].points.empty()) continue;
        std::string data = "$" + kind + std::to_string(i), color = curves[i].method->color;
        char slope[32];
        std::snprintf(slope, sizeof slope, "  %.2f", curves[i].slope);
        plot +=
            data + " using 1:3:4 with filledcurves fs transparent solid 0.2 noborder lc rgb '" +
            color + "' notitle, " + data + " using 1:2 with linespoints lw 2.5 pt 7 ps 0.7 " +
            "lc rgb '" + color + "' " +
            (titles ? "title " + quoted_for_gnuplot(curves[i].method->label + slope) : "notitle") +
            ", ";
    }
    return plot;
}

}  // namespace

void draw_curves(const std::string& path, const std::string& title,
                 const std::vector<Curve>& curves) {
    std::string script;
    double first = INFINITY, last = 0, rmse = 0, rel_mse = 0;
    for (size_t i = 0; i < curves.size(); i++) {
        script += data_block("rmse" + std::to_string(i),
                             rows_of(curves[i], &CurvePoint::rmse, root_mean_square));
        script += data_block("relmse" + std::to_string(i),
                             rows_of(curves[i], &CurvePoint::rel_mse, mean_of));
        for (const CurvePoint& p : curves[i].points) {
            first = std::min(first, p.seconds), last = std::max(last, p.seconds);
            rmse = std::max(rmse, root_mean_square(p.rmse));
            rel_mse = std::max(rel_mse, mean_of(p.rel_mse));
        }
    }
    // Four times the samples, half the error: a dashed line above the noisiest.
    std::string theory = digits(rmse) + "*sqrt(" + digits(first) + "/x)";
    std::string theory_squared = digits(rel_mse) + "*" + digits(first) + "/x";
    script += "set multiplot layout 1,2 title " + quoted_for_gnuplot(title) +
              " margins 0.075,0.68,0.13,0.88 spacing 0.085\n"
              "set logscale xy\nset format xy '1e%T'\nset grid lt 1 lc rgb '#dddddd'\n"
              "set xrange [" +
              digits(first / 1.5) + ":" + digits(last * 1.5) +
              "]\n"
              "set xlabel 'seconds of one render'\nunset key\n"
              "set ylabel 'RMSE (radiance)' offset 1\n" +
              plot_commands(curves, "rmse", false) + theory +
              " with lines dt 2 lc rgb '#444444' notitle\n"
              "set ylabel 'relMSE' offset 1\n"
              "set key at screen 0.695,0.87 left top Left reverse samplen 1.5 spacing 1.25 title "
              "'slope of the RMSE over samples' left\n" +
              plot_commands(curves, "relmse", true) + theory_squared +
              " with lines dt 2 lc rgb '#444444' title 'theory  -0.50'\nunset multiplot";
    draw_chart(path, script, 1500, 560);
}

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

ErrorLine Curve::rel_mse_over_time() const {
    ErrorLine line;
    for (const CurvePoint& p : points) {
        line.seconds.push_back(p.seconds);
        line.error.push_back(mean_of(p.rel_mse));
    }
    return line;
}

const Curve* measure_of_all(const std::vector<Curve>& curves) {
    for (const Curve& c : curves)
        if (c.falls()) return &c;
    return nullptr;
}

static double ratio(const Curve& curve, const Curve& first) {
    return times_faster(curve.rel_mse_over_time(), first.rel_mse_over_time());
}

std::string times_faster(const Curve& curve, const Curve* first) {
    if (curve.points.empty() || !first) return "-";
    return curve.flat() ? "never" : two_digits(ratio(curve, *first));
}

std::string finding(const std::string& scene, const std::vector<Curve>& curves) {
    const Curve* first = measure_of_all(curves);
    if (!first) return scene + ": error against time";
    std::vector<double> ratios;
    for (const Curve& c : curves) {
        ratios.push_back(c.falls() && !c.method->biased ? ratio(c, *first) : 0);
    }
    size_t named = simplest_of_the_best(ratios);
    const std::string &name = curves[named].method->name, &than = first->method->name;
    if (name == than) return scene + ": none is much faster than " + than;
    bool best = ratios[named] == *std::max_element(ratios.begin(), ratios.end());
    return scene + ": " + name + " is " + two_digits(ratios[named]) + " times faster than " + than +
           " at equal error" + (best ? "" : ", none much faster");
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

// The drawing, in pixels: the plot, and right of it the names.
constexpr int width = 1000, height = 640;
constexpr double left = 95, right = 610, top = 60, bottom = 125, names = 665, line_height = 21;

std::string at(double x, double y) {
    return "screen " + digits(x / width) + "," + digits(1 - y / height);
}

std::string text_at(const std::string& text, double x, double y, int size = 15) {
    return "set label " + quoted_for_gnuplot(text) + " at " + at(x, y) + " font '," +
           std::to_string(size) + "'\n";
}

/// One row for each point: seconds, then relMSE: its mean, its least, its most.
std::vector<std::vector<double>> rows_of(const Curve& curve) {
    std::vector<std::vector<double>> rows;
    for (const CurvePoint& p : curve.points) {
        auto [low, high] = std::minmax_element(p.rel_mse.begin(), p.rel_mse.end());
        rows.push_back({p.seconds, mean_of(p.rel_mse), *low, *high});
    }
    return rows;
}

struct Range {
    double low = INFINITY, high = 0;
    void add(double x) { low = std::min(low, x), high = std::max(high, x); }
    std::string text() const { return digits(low) + ":" + digits(high); }
};

/// Names in a column right of the plot, each joined with the end of its line.
std::string names_of(const std::vector<Curve>& curves, const Range& error) {
    std::vector<const Curve*> drawn;
    std::vector<double> wanted;
    double pixels = (height - top - bottom) / std::log(error.high / error.low);
    for (const Curve& c : curves) {
        if (c.points.empty()) continue;
        drawn.push_back(&c);
        wanted.push_back(top + pixels * std::log(error.high / mean_of(c.points.back().rel_mse)));
    }
    const Curve* first = measure_of_all(curves);
    std::vector<double> y =
        spread_out(wanted, line_height, top + 55, height - bottom + line_height);
    std::string script;
    if (first) {
        double above = *std::min_element(y.begin(), y.end()) - 2.4 * line_height;
        script = text_at("at equal error so many times", names, above) +
                 text_at("faster than " + first->method->name + ":", names, above + line_height);
    }
    for (size_t i = 0; i < drawn.size(); i++) {
        const Method& m = *drawn[i]->method;
        const CurvePoint& end = drawn[i]->points.back();
        script += "set arrow from first " + digits(end.seconds) + "," +
                  digits(mean_of(end.rel_mse)) + " to " + at(names - 6, y[i]) +
                  " nohead lw 1 lc rgb '" + m.color + "'\n" +
                  text_at(m.label + ": " + times_faster(*drawn[i], first), names, y[i]);
    }
    return script;
}

}  // namespace

void draw_curves(const std::string& path, const std::string& scene,
                 const std::vector<Curve>& curves) {
    std::string script = "set encoding utf8\n", bands, lines;
    Range time, error;
    size_t runs = 0;
    for (size_t i = 0; i < curves.size(); i++) {
        if (curves[i].points.empty()) continue;
        std::string data = "$line" + std::to_string(i),
                    color = "lc rgb '" + curves[i].method->color + "' notitle, ";
        script += data_block(data.substr(1), rows_of(curves[i]));
        bands += data + " using 1:3:4 with filledcurves fs transparent solid 0.2 noborder " + color;
        lines += data + " using 1:2 with linespoints lw 2.5 pt 7 ps 0.6 " + color;
        for (const CurvePoint& p : curves[i].points) {
            runs = p.rel_mse.size();
            time.add(p.seconds);
            for (double x : p.rel_mse) error.add(x);
        }
    }
    if (bands.empty()) return;
    // Where four times the samples halve the RMSE: a dashed line from where the first one starts.
    double theory = 0;
    if (const Curve* first = measure_of_all(curves)) {
        theory = first->points[0].seconds * mean_of(first->points[0].rel_mse);
    }
    time.low /= 1.5, time.high *= 1.3, error.low /= 1.3, error.high *= 1.5;
    script += "set lmargin at " + at(left, 0).substr(0, at(left, 0).find(',')) +
              "\nset rmargin at " + at(right, 0).substr(0, at(right, 0).find(',')) +
              "\nset tmargin at screen " + digits(1 - top / height) + "\nset bmargin at screen " +
              digits(bottom / height) +
              "\nset logscale xy\nset format xy '1e%T'\nset grid lt 1 lc rgb '#dddddd'\nunset "
              "key\nset xrange [" +
              time.text() + "]\nset yrange [" + error.text() +
              "]\nset xlabel 'seconds of one render'\nset ylabel 'relMSE' offset 1\n" +
              "set label " + quoted_for_gnuplot(finding(scene, curves)) + " at " +
              at(width / 2.0, 28) + " center font ',20'\n" + names_of(curves, error) +
              text_at("Bands: the least and the largest error of " + std::to_string(runs) +
                          " renders with other random numbers. Dashed: a quarter of the relMSE",
                      20, height - 48, 13) +
              text_at(
                  "(half the RMSE) in four times the time; beyond its end a line is taken to "
                  "go on so.",
                  20, height - 30, 13) +
              text_at(
                  "relMSE: mean of error² / (brightness² + 0.01), against a reference that "
                  "other methods made.",
                  20, height - 12, 13) +
              "plot " + bands + lines + digits(theory) +
              "/x with lines dt 2 lw 1.5 lc rgb '#444444' notitle";
    draw_chart(path, script, width, height);
}

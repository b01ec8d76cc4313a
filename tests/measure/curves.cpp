#include "tests/measure/curves.h"

#include <algorithm>
#include <cmath>

#include "common/picture/comparison.h"
#include "tests/measure/lines.h"

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

/// Of log RMSE over log samples, from the last three points; NaN for one.
static double last_slope(const std::vector<CurvePoint>& points) {
    std::vector<double> spp, rmse;
    for (size_t i = points.size() - std::min<size_t>(3, points.size()); i < points.size(); i++) {
        spp.push_back(points[i].spp);
        rmse.push_back(root_mean_square(points[i].rmse));
    }
    return fitted_slope(spp, rmse);
}

Curve measure_curve(const NamedMethod& method, Scene& scene, const Reference& reference,
                    const MeasureOptions& o, double seconds) {
    Curve curve{&method, {}, NAN};
    double spent = 0, next = 0;
    // What is biased gets longer, until chance is small beside its bias.
    auto time_left = [&] {
        return spent + next < (method.biased() && !curve.flat() ? 16 * seconds : seconds);
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
        if (!method.biased() && root_mean_square(point.rmse) < 10 * reference.rmse) break;
        curve.points.push_back(point);
        curve.slope = last_slope(curve.points);
    }
    return curve;
}

void draw_curves(const std::string& folder, const std::string& scene,
                 const std::vector<Curve>& curves) {
    const Curve* first = measure_of_all(curves);
    std::vector<Line> lines;
    for (const Curve& c : curves) {
        ErrorLine line = c.rel_mse_over_time();
        std::string than = first ? ", times faster: " + times_faster(c, first) : "";
        lines.push_back({scene, c.method->label + than, c.method->color, line.seconds, line.error});
    }
    write_lines(folder, "chart-" + file_name(scene), scene + ": error against time",
                "seconds of one render", "relMSE", lines);
}

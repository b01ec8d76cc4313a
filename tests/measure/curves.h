// Error against time: a method's renders of one scene with ever more samples.
#pragma once
#include <string>
#include <vector>

#include "tests/measure/finding.h"
#include "tests/measure/measure.h"
#include "tests/measure/reference.h"

/// The renders with one number of samples.
struct CurvePoint {
    int spp;
    double seconds;                     // of one render: processor time over threads
    std::vector<double> rmse, rel_mse;  // of each run, against the reference
};

struct Curve {
    const NamedMethod* method;
    std::vector<CurvePoint> points;
    double slope = NAN;  // fitted: log RMSE over log spp, last 3 points; in theory -1/2

    ErrorLine rel_mse_over_time() const;
    bool flat() const { return slope > -0.25; }
    bool falls() const { return !points.empty() && !flat(); }
};

/// The first of those whose error falls: the measure of the others; null: none.
const Curve* measure_of_all(const std::vector<Curve>& curves);

/// How many times faster than `first` at equal error; "never" for one that stays at its bias, "-"
/// for one that is exact from the first sample on.
std::string times_faster(const Curve& curve, const Curve* first);

/// Root of the mean of the squares; mean.
double root_mean_square(const std::vector<double>& values);
double mean_of(const std::vector<double>& values);

/// Renders with 1, 4, 16, ... spp, `runs` of each, for about `seconds` of all processors together,
/// and as long as the error is at least 10 times the reference's own.
Curve measure_curve(const NamedMethod& method, Scene& scene, const Reference& reference,
                    const MeasureOptions& o, double seconds);

/// Writes chart-SCENE.tsv, relMSE over seconds, and draws it: how many times faster than the first
/// each method is stands behind its name.
void draw_curves(const std::string& folder, const std::string& scene,
                 const std::vector<Curve>& curves);

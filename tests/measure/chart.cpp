// Error against time for every method and scene: charts, and a table.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "common/base/error.h"
#include "common/picture/comparison.h"
#include "common/scene/prepare.h"
#include "tests/measure/measure.h"

namespace {

/// The error of a method's renders of one scene with ever more samples, against the reference.
struct Curve {
    const NamedMethod* method;
    std::vector<double> spp = {}, rmse = {};
    ErrorLine rel_mse = {};  // over the seconds of one render: processor time over threads
    double slope = NAN;      // fitted: log RMSE over log spp, last 3 points; in theory -1/2

    bool flat() const { return slope > -0.25; }
    bool falls() const { return !spp.empty() && !flat(); }
};

/// What all methods are compared with.
struct Truth {
    Image image;
    double rmse = 0;  // expected of it
};
Truth truth_of(const Scene& scene) {
    std::string name = file_name(scene_name(scene.origin->file));
    auto references = read_references();
    const Reference& reference = references[name];
    Image image = read_image(reference_folder + name + ".pfm");
    if (reference.max_depth != scene.max_depth || image.width != scene.width ||
        image.height != scene.height)
        throw InputError(name + ": error: no reference like this; run: make references");
    return {image, reference.rmse};
}

/// The first of those whose error falls: the measure of the others; null: none.
const Curve* measure_of_all(const std::vector<Curve>& curves) {
    for (const Curve& c : curves)
        if (c.falls()) return &c;
    return nullptr;
}

/// How many times faster than `first` at equal error; "never" for one that stays at its bias, "-"
/// for one that is exact from the first sample on.
std::string times_faster(const Curve& curve, const Curve* first) {
    if (curve.spp.empty() || !first) return "-";
    return curve.flat() ? "never" : short_number(times_faster(curve.rel_mse, first->rel_mse));
}

/// Renders with 1, 4, 16, ... spp, `runs` of each, for about `seconds` of all processors together,
/// and as long as the error is at least 10 times the reference's own.
Curve measure_curve(const NamedMethod& method, Scene& scene, const Truth& truth,
                    const MeasureOptions& o, double seconds) {
    Curve curve{&method};
    double spent = 0, next = 0;
    // What is biased gets longer, until chance is small beside its bias.
    auto time_left = [&] {
        return spent + next < (method.biased() && !curve.flat() ? 16 * seconds : seconds);
    };
    for (int spp = 1; spp <= 1 << 20 && (spp <= 16 || time_left()); spp *= 4) {
        RunningStats squares, rel_mse, time;
        for (int run = 0; run < o.runs; run++) {
            uint32_t seed = 0x10000u * static_cast<uint32_t>(run + 1) + static_cast<uint32_t>(spp);
            Rendering r = render_once(method, scene, o, spp, seed);
            Comparison c = compare(r.film.image(), truth.image);
            squares.add(c.mse), rel_mse.add(c.rel_mse), time.add(r.stats.seconds);
        }
        double cost = time.mean() * o.runs * o.threads, rmse = std::sqrt(squares.mean());
        spent += cost;
        next = 4 * cost;
        if (!method.biased() && rmse < 10 * truth.rmse) break;
        curve.spp.push_back(spp), curve.rmse.push_back(rmse);
        curve.rel_mse.seconds.push_back(time.mean());
        curve.rel_mse.error.push_back(rel_mse.mean());
        auto last = std::min<std::ptrdiff_t>(3, std::ssize(curve.spp));
        curve.slope = fitted_slope({curve.spp.end() - last, curve.spp.end()},
                                   {curve.rmse.end() - last, curve.rmse.end()});
    }
    return curve;
}

/// Writes chart-SCENE.tsv, relMSE over seconds, and draws it: how many times faster than the first
/// each method is stands behind its name.
void draw_curves(const std::string& folder, const std::string& scene,
                 const std::vector<Curve>& curves) {
    const Curve* first = measure_of_all(curves);
    std::vector<Line> lines;
    for (const Curve& c : curves) {
        std::string than = first ? ", times faster: " + times_faster(c, first) : "";
        lines.push_back(
            {scene, c.method->label + than, c.method->color, c.rel_mse.seconds, c.rel_mse.error});
    }
    write_lines(folder, "chart-" + file_name(scene), scene + ": error against time",
                "seconds of one render", "relMSE", lines);
}

/// All curves of a scene.
std::vector<Curve> measure_scene(const std::string& path, const std::vector<NamedMethod>& methods,
                                 const MeasureOptions& o, double seconds) {
    Scene scene = load_scene_for(path, o);
    Truth truth = truth_of(scene);
    std::vector<Curve> curves;
    for (const NamedMethod& method : methods) {
        if (!can_render(method, scene)) continue;
        curves.push_back(measure_curve(method, scene, truth, o, seconds));
    }
    return curves;
}

void add_summary(const std::string& scene, const std::vector<Curve>& curves, Table& summary) {
    const Curve* first = measure_of_all(curves);
    for (const Curve& c : curves) {
        std::vector<std::string> row = {scene, c.method->label, "0", "0", "0", "exact"};
        if (!c.spp.empty())
            row = {scene,
                   c.method->label,
                   short_number(c.spp.back()),
                   short_number(c.rel_mse.seconds.back()),
                   short_number(c.rel_mse.error.back()),
                   short_number(c.slope)};
        row.push_back(times_faster(c, first));
        summary.rows.push_back(row);
    }
}

/// Those that are asked for, or all; on some scenes also variants that fail there.
std::vector<NamedMethod> methods_for(const MeasureOptions& o, const std::string& scene) {
    std::vector<std::string> names = o.methods;
    if (names.empty()) {
        names = {"all", "15-sobol"};
        if (scene == "veach-mis") names.push_back("13-bsdf");
    }
    return methods_named(names);
}

}  // namespace

int main(int argc, char** argv) {
    return run_program([&] {
        MeasureOptions o = parse_measure_options(
            argc, argv, "[SCENE...]",
            "Error against time of every method on every scene, against references of known error "
            "(make references). Writes chart-SCENE.svg and .tsv, and chart-summary.tsv.",
            {.spp = 0, .runs = 4, .width = 64, .height = 64, .seconds = 600});
        if (o.words.empty()) o.words = own_scenes();
        Work work("chart: error against time on " + std::to_string(o.words.size()) + " scenes",
                  static_cast<double>(o.words.size()), o.seconds);
        Table summary{{"scene", "method", "spp", "seconds", "relMSE", "slope", "times faster"}, {}};
        for (const std::string& word : o.words) {
            std::string path = find_scene(word), name = scene_name(path);
            work.next(name);
            std::vector<NamedMethod> methods = methods_for(o, name);
            double seconds = o.seconds * o.threads / static_cast<double>(o.words.size()) /
                             static_cast<double>(methods.size());
            std::vector<Curve> curves;
            try {
                curves = measure_scene(path, methods, o, seconds);
            } catch (const InputError& e) {
                std::printf("left out: %s\n", e.what());
                continue;
            }
            add_summary(name, curves, summary);
            draw_curves(o.out, name, curves);
        }
        write_table(o.out, "chart-summary", summary);
        std::printf("%s", markdown(summary).c_str());
        std::printf(
            "slope: of log RMSE over log samples; in theory -0.50. times faster: at equal "
            "error,\nagainst the first method of the scene; never: it stays at its bias; "
            "exact: below 10 times\nthe error of the reference from the first sample on.\n");
        return 0;
    });
}

// Error against time for every method and scene: charts, and a table.
#include <cstdio>

#include "common/base/error.h"
#include "tests/measure/curves.h"
#include "tests/support/work.h"

namespace {

/// All curves of a scene, each against references made by other methods.
std::vector<Curve> measure_scene(const std::string& path, const std::vector<NamedMethod>& methods,
                                 const MeasureOptions& o, double seconds, Work& work) {
    Scene scene = load_scene_for(path, o);
    std::vector<Curve> curves;
    for (const NamedMethod& method : methods) {
        work.next(scene_name(path) + ", " + method.name);
        if (!can_render(method, scene)) continue;
        Reference reference =
            reference_for(scene_name(path), method, scene.width, scene.height, scene.max_depth);
        curves.push_back(measure_curve(method, scene, reference, o, seconds));
    }
    return curves;
}

void add_summary(const std::string& scene, const std::vector<Curve>& curves, Table& summary) {
    const Curve* first = measure_of_all(curves);
    for (const Curve& c : curves) {
        std::string slope = "exact";
        if (!c.points.empty()) {
            char text[32];
            std::snprintf(text, sizeof text, "%.2f", c.slope);
            slope = text;
        }
        const CurvePoint none{0, 0, {}, {}};
        const CurvePoint& last = c.points.empty() ? none : c.points.back();
        summary.rows.push_back({scene, c.method->label, std::to_string(last.spp),
                                short_number(last.seconds), short_number(mean_of(last.rel_mse)),
                                slope, times_faster(c, first)});
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

/// One step for each method on each scene.
size_t steps_of(const MeasureOptions& o) {
    size_t steps = 0;
    for (const std::string& word : o.words) {
        steps += methods_for(o, scene_name(find_scene(word))).size();
    }
    return steps;
}

}  // namespace

int main(int argc, char** argv) {
    return run_program([&] {
        MeasureOptions o = parse_measure_options(
            argc, argv, "[SCENE...]",
            "Error against time of every method on every scene, against references of known error "
            "(make references). Writes chart-SCENE.svg, .png and .tsv, and chart-summary.tsv.",
            {.spp = 0, .runs = 4, .width = 64, .height = 64, .seconds = 600});
        if (o.words.empty()) {
            o.words = own_scenes();
        }
        Work work("chart: error against time on " + std::to_string(o.words.size()) + " scenes",
                  static_cast<double>(steps_of(o)), o.seconds);
        Table summary{{"scene", "method", "spp", "seconds", "relMSE", "slope", "times faster"}, {}};
        for (const std::string& word : o.words) {
            std::string path = find_scene(word), name = scene_name(path);
            std::vector<NamedMethod> methods = methods_for(o, name);
            double seconds = o.seconds * o.threads / static_cast<double>(o.words.size()) /
                             static_cast<double>(methods.size());
            std::vector<Curve> curves;
            try {
                curves = measure_scene(path, methods, o, seconds, work);
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

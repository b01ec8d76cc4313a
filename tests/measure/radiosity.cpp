// Error against time of radiosity with ever more patches, beside path tracing with ever more paths.
#include <cstdio>

#include "chapters/14_mis_ris/estimator.h"
#include "chapters/20_radiosity/run.h"
#include "common/picture/comparison.h"
#include "tests/measure/lines.h"
#include "tests/measure/measure.h"
#include "tests/support/work.h"

namespace {

/// Radiosity of one number of patches: how long it took, and how far off its pictures are.
struct Solved {
    size_t patches;
    double seconds, constant, smooth;
};

Image image_of(const Scene& scene, const Trace& trace, uint32_t seed, int threads) {
    RenderOptions options;
    options.quiet = true, options.threads = threads, options.seed = seed;
    return render_film(scene, options, trace).film.image();
}

/// The reference has the same points of each pixel, so that its edges cancel and light is left.
Solved solve_and_compare(const Scene& scene, size_t wanted, const Image& reference, int threads) {
    Stopwatch watch;
    auto patches = std::make_shared<ch20::Patches>(ch20::make_patches(scene, wanted, threads));
    const std::vector<ch20::Patch>& patch = patches->patch;
    ch20::Rows rows(scene, *patches, ch20::FormFactors::contour, 0, threads);
    ch20::Matrix m = ch20::make_matrix(rows, patch.size());
    ch20::repair(m, patch, patches->closed);
    ch20::Solution s;
    ch20::solve(m, patch, 1e-6, s, ch20::sweep_gauss_seidel, [](double) { return false; });
    Solved result{patch.size(), watch.seconds() / threads, 0, 0};
    auto error = [&](ch20::Show how) {
        ch20::Shown shown = ch20::show(scene, patches, s, how, threads);
        return compare(image_of(scene, trace_with<ch20::trace>(shown), 0, threads), reference)
            .rel_mse;
    };
    result.constant = error(ch20::Show::constant), result.smooth = error(ch20::Show::smooth);
    return result;
}

void report(const std::vector<Solved>& solved, const std::vector<std::array<double, 3>>& paths,
            const MeasureOptions& o, const std::string& name) {
    Table table{{name, "seconds", "relMSE, constant", "relMSE, smooth"}, {}};
    Line constant{"20, constant", "#8c564b", "", {}, {}},
        smooth{"20, smooth", "#17becf", "", {}, {}};
    Line traced{"14", "#d62728", "-1", {}, {}};
    for (const Solved& s : solved) {
        table.rows.push_back({"20, " + std::to_string(s.patches) + " patches",
                              short_number(s.seconds), short_number(s.constant),
                              short_number(s.smooth)});
        constant.x.push_back(s.seconds), constant.y.push_back(s.constant);
        smooth.x.push_back(s.seconds), smooth.y.push_back(s.smooth);
    }
    for (auto [spp, seconds, error] : paths) {
        table.rows.push_back({"14, " + short_number(spp) + " paths a pixel", short_number(seconds),
                              short_number(error), ""});
        traced.x.push_back(seconds), traced.y.push_back(error);
    }
    std::printf("%s", markdown(table).c_str());
    write_table(o.out, "chart-radiosity", table);
    draw_panels(o.out + "/chart-radiosity", "Radiosity beside path tracing: " + name,
                {{name, "seconds", "relMSE", {constant, smooth, traced}}}, 1);
}

}  // namespace

int main(int argc, char** argv) {
    return run_program([&] {
        MeasureOptions o = parse_measure_options(
            argc, argv, "[SCENE]",
            "relMSE against time: patches of chapter 20, paths of chapter 14. Writes "
            "chart-radiosity.svg, .png and .tsv.",
            {.spp = 1024, .width = 64, .height = 64, .max_depth = 60});
        std::string name = o.words.empty() ? "cornell" : o.words[0];
        Scene scene = load_scene_for("scenes/" + name + ".pbrt", o);
        ch20::refuse(scene);
        ch20::tessellate(scene, o.threads);
        Trace fourteen = trace_with<ch14::trace>(ch14::prepare(scene));
        scene.spp = o.spp;
        Work work("radiosity: patches of chapter 20 beside paths of 14, " + name, 10);
        work.next("reference");
        Image reference = image_of(scene, fourteen, 0, o.threads);
        std::vector<Solved> solved;
        for (size_t patches : {size_t{80}, size_t{320}, size_t{1280}, size_t{5120}}) {
            work.next(std::to_string(patches) + " patches");
            solved.push_back(solve_and_compare(scene, patches, reference, o.threads));
        }
        std::vector<std::array<double, 3>> paths;
        for (int spp : {1, 4, 16, 64, 256}) {
            work.next(std::to_string(spp) + " paths a pixel");
            scene.spp = spp;
            Stopwatch watch;
            Image image = image_of(scene, fourteen, 1, o.threads);
            double seconds = watch.seconds() / o.threads;
            paths.push_back({double(spp), seconds, compare(image, reference).rel_mse});
        }
        report(solved, paths, o, name);
        return 0;
    });
}

// Error against time of radiosity with ever more patches, beside path tracing with ever more paths.
#include "common/path/radiosity.h"

#include <cstdio>

#include "chapters/26_radiosity/run.h"
#include "common/picture/comparison.h"
#include "tests/measure/measure.h"

namespace {

using ch26::Show, ch26::Shown;

/// Radiosity of one number of patches: how long it took, and how far off its pictures are.
struct Solved {
    size_t patches;
    double seconds, constant, smooth;
};

/// The reference has the same points of each pixel, so that its edges cancel and light is left.
Solved solve_and_compare(Scene& scene, size_t wanted, const Image& reference,
                         const MeasureOptions& o) {
    Stopwatch watch;
    int threads = o.threads;
    auto patches = std::make_shared<ch26::Patches>(ch26::make_patches(scene, wanted, threads));
    const std::vector<ch26::Patch>& patch = patches->patch;
    ch26::Matrix G(patch.size());
    ch26::ExchangeOf exchange = ch26::form_factors(scene, *patches, 0);
    for (size_t i = 0; i < G.size(); i++) ch26::row_of(G, i, threads, exchange);
    ch26::repair(G, patch, patches->closed);
    ch26::Solution s;
    ch26::solve(G, patch, ch26::Sweep::gauss_seidel, 1e-6, s);
    Solved result{patch.size(), watch.seconds() / threads, 0, 0};
    auto error = [&](Show how) {
        Shown shown = ch26::show(scene, patches, s, how, threads);
        NamedMethod method{.name = "26",
                           .make = [&](auto&, auto&) { return method_of<ch26::trace>(shown); }};
        return compare(render_once(method, scene, o, o.spp, 0).film.image(), reference).rel_mse;
    };
    result.constant = error(Show::constant), result.smooth = error(Show::smooth);
    return result;
}

}  // namespace

int main(int argc, char** argv) {
    return run_program([&] {
        MeasureOptions o = parse_measure_options(
            argc, argv, "[SCENE]",
            "relMSE against time: patches of chapter 26, paths of chapter 15. Writes "
            "chart-radiosity.svg and .tsv.",
            {.spp = 1024, .width = 64, .height = 64, .max_depth = 60});
        std::string path = find_scene(o.words.empty() ? "cornell" : o.words[0]);
        std::string name = scene_name(path);
        Scene scene = load_scene_for(path, o);
        refuse(scene);
        tessellate(scene, o.threads);
        NamedMethod fifteen = methods_named({"15"})[0];
        Work work("radiosity: patches of chapter 26 beside paths of 15, " + name, 10);
        work.next("reference");
        Image reference = render_once(fifteen, scene, o, o.spp, 0).film.image();
        Table table{{name, "seconds", "relMSE, constant", "relMSE, smooth"}, {}};
        std::vector<Line> lines = {{name, "26, constant", "#8c564b"},
                                   {name, "26, smooth", "#17becf"},
                                   {name, "15", "#d62728"}};
        auto add = [&](size_t line, double seconds, double error) {
            lines[line].x.push_back(seconds), lines[line].y.push_back(error);
            return short_number(error);
        };
        for (size_t patches : {size_t{80}, size_t{320}, size_t{1280}, size_t{5120}}) {
            work.next(std::to_string(patches) + " patches");
            Solved s = solve_and_compare(scene, patches, reference, o);
            table.rows.push_back({"26, " + std::to_string(s.patches) + " patches",
                                  short_number(s.seconds), add(0, s.seconds, s.constant),
                                  add(1, s.seconds, s.smooth)});
        }
        for (int spp : {1, 4, 16, 64, 256}) {
            work.next(std::to_string(spp) + " paths a pixel");
            Rendering r = render_once(fifteen, scene, o, spp, 1);
            double error = compare(r.film.image(), reference).rel_mse;
            table.rows.push_back({"15, " + std::to_string(spp) + " paths a pixel",
                                  short_number(r.stats.seconds), add(2, r.stats.seconds, error),
                                  ""});
        }
        std::printf("%s", markdown(table).c_str());
        write_lines(o.out, "chart-radiosity", "Radiosity beside path tracing: " + name, "seconds",
                    "relMSE", lines);
        return 0;
    });
}

// Chapter 13 as a program: reads options, loads a scene, renders it, writes the picture.
#include "chapters/13_mis/estimator.h"
#include "common/program/render.h"

int main(int argc, char** argv) {
    return run_program([&] {
        ch13::Settings settings;
        std::vector<Option> extra = {
            {"heuristic", "KIND", "power (default) or balance",
             [&](const std::string& text) {
                 bool power = parse_choice("heuristic", text, {"balance", "power"}) == 1;
                 settings.heuristic = power ? ch13::power_heuristic : ch13::balance_heuristic;
             },
             "power"},
            {"ways", "N", "at each vertex: both (default), or one-sample: one of them, by a coin",
             [&](const std::string& text) {
                 settings.one_sample = parse_choice("ways", text, {"both", "one-sample"}) == 1;
             },
             "both"},
        };
        RenderOptions options =
            parse_render_options(argc, argv, "13_mis", "scenes/veach-mis.pbrt", extra);
        Scene scene = load(options);
        return render(scene, options, trace_with<ch13::trace>(ch13::prepare(scene), settings));
    });
}

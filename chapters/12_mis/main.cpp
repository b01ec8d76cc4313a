// Chapter 12 as a program: reads options, loads a scene, renders it, writes the picture.
#include "chapters/12_mis/estimator.h"
#include "common/program/render.h"

int main(int argc, char** argv) {
    using ch12::Heuristic, ch12::Strategy, ch12::settings;
    return run_program([&] {
        std::vector<Option> extra = {
            {"strategy", "KIND", "mis (default), one-sample, or bsdf or light alone",
             [](const std::string& text) {
                 settings.strategy = static_cast<Strategy>(
                     parse_choice("strategy", text, {"bsdf", "light", "mis", "one-sample"}));
             }},
            {"heuristic", "KIND", "power (default) or balance",
             [](const std::string& text) {
                 settings.heuristic =
                     static_cast<Heuristic>(parse_choice("heuristic", text, {"balance", "power"}));
             }},
            {"m", "M", "light candidates, at most one per light (default 64)",
             [](const std::string& text) {
                 settings.M = static_cast<int>(parse_integer("m", text, 1, Candidates::most));
             }},
        };
        RenderOptions options =
            parse_render_options(argc, argv, "12_mis", "scenes/veach-mis.pbrt", extra);
        Scene scene = load(options);
        ch12::prepare(scene);
        return render(scene, options, ch12::trace);
    });
}

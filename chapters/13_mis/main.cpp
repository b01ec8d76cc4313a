// Chapter 13 as a program: reads options, loads a scene, renders it, writes the picture.
#include "chapters/13_mis/estimator.h"
#include "common/program/render.h"

int main(int argc, char** argv) {
    using ch13::Strategy;
    return run_program([&] {
        ch13::Settings settings;
        std::vector<Option> extra = {
            {"strategy", "KIND", "mis (default), one-sample, or bsdf or light alone",
             [&](const std::string& text) {
                 settings.strategy = static_cast<Strategy>(
                     parse_choice("strategy", text, {"bsdf", "light", "mis", "one-sample"}));
             }},
            {"heuristic", "KIND", "power (default) or balance",
             [&](const std::string& text) {
                 bool power = parse_choice("heuristic", text, {"balance", "power"}) == 1;
                 settings.heuristic = power ? ch13::power_heuristic : ch13::balance_heuristic;
             }},
        };
        RenderOptions options =
            parse_render_options(argc, argv, "13_mis", "scenes/veach-mis.pbrt", extra);
        Scene scene = load(options);
        if (settings.strategy == Strategy::bsdf) refuse_delta_lights(scene);
        return render(scene, options, trace_with<ch13::trace>(ch13::prepare(scene), settings));
    });
}

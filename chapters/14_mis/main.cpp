// Chapter 14 as a program: reads options, loads a scene, renders it, writes the picture.
#include "chapters/14_mis/estimator.h"
#include "common/program/render.h"

int main(int argc, char** argv) {
    return run_program([&] {
        auto* heuristic = ch14::power_heuristic;
        Option kind = {"heuristic", "KIND", "power (default) or balance",
                       [&](const std::string& text) {
                           bool power = parse_choice("heuristic", text, {"balance", "power"}) == 1;
                           heuristic = power ? ch14::power_heuristic : ch14::balance_heuristic;
                       },
                       "power"};
        RenderOptions options =
            parse_render_options(argc, argv, "14_mis", "scenes/veach-mis.pbrt", {kind});
        Scene scene = load(options);
        auto lights = ch14::prepare(scene, heuristic);
        return render(scene, options, method_of<ch14::trace>(lights));
    });
}

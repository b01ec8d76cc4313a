// Chapter 14 as a program: reads options, loads a scene, renders it, writes the picture.
#include "chapters/14_mis/estimator.h"
#include "common/render/program.h"

int main(int argc, char** argv) {
    return run_program([&] {
        bool power = true;
        Option kind = choice_option("heuristic", "KIND", "power (default) or balance",
                                    {"balance", "power"}, power);
        RenderOptions options =
            parse_render_options(argc, argv, "14_mis", {"scenes/veach-mis.pbrt", 16}, {kind});
        Scene scene = load(options, features_of(14));
        auto lights = ch14::prepare(scene, power ? ch14::power_heuristic : ch14::balance_heuristic);
        return render(scene, options, method_of<ch14::trace>(lights));
    });
}

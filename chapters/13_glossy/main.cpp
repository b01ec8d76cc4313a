// Chapter 13 as a program: reads options, loads a scene, renders it, writes the picture.
#include "chapters/13_glossy/estimator.h"
#include "common/render/program.h"

int main(int argc, char** argv) {
    return run_program([&] {
        auto strategy = ch13::Strategy::light;
        Option ways = choice_option("strategy", "KIND",
                                    "how to find light: sample light (default) or sample bsdf",
                                    {"bsdf", "light"}, strategy);
        RenderOptions options =
            parse_render_options(argc, argv, "13_glossy", {"scenes/veach-mis.pbrt", 16}, {ways});
        Scene scene = load(options, features_of(13));
        if (strategy == ch13::Strategy::bsdf) {
            refuse_delta_lights(scene);
            options.search = LightSearch::random_hits;
        }
        return render(scene, options, method_of<ch13::trace>(ch13::prepare(scene), strategy));
    });
}

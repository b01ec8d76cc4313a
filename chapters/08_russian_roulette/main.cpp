// Chapter 08 as a program: reads options, loads a scene, renders it, writes the picture.
#include "chapters/08_russian_roulette/estimator.h"
#include "common/render/program.h"

int main(int argc, char** argv) {
    return run_program([&] {
        RenderOptions options =
            parse_render_options(argc, argv, "08_russian_roulette", {"scenes/cornell.pbrt", 64});
        options.search = LightSearch::random_hits;
        Scene scene = load(options, features_of(8));
        refuse_delta_lights(scene);
        return render(scene, options, method_of<ch08::trace>());
    });
}

// Chapter 07 as a program: reads options, loads a scene, renders it, writes the picture.
#include "chapters/07_path_tracing/estimator.h"
#include "common/render/program.h"

int main(int argc, char** argv) {
    return run_program([&] {
        RenderOptions options =
            parse_render_options(argc, argv, "07_path_tracing", {"scenes/cornell.pbrt", 32});
        options.search = LightSearch::random_hits;
        Scene scene = load(options, features_of(7));
        refuse_delta_lights(scene);
        return render(scene, options, method_of<ch07::trace>());
    });
}

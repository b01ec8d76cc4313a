// Chapter 20 as a program: reads options, loads a scene, renders it, writes the picture.
#include "chapters/20_light_tracing/estimator.h"
#include "common/render/program.h"

int main(int argc, char** argv) {
    return run_program([&] {
        RenderOptions options =
            parse_render_options(argc, argv, "20_light_tracing", {"scenes/caustic.pbrt", 64});
        options.search = LightSearch::from_lights;
        Scene scene = load(options, features_of(20));
        return render(scene, options, method_of<ch20::trace_light>(ch20::endpoints_of(scene)));
    });
}

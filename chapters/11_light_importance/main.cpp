// Chapter 11 as a program: reads options, loads a scene, renders it, writes the picture.
#include "chapters/11_light_importance/estimator.h"
#include "common/render/program.h"

int main(int argc, char** argv) {
    return run_program([&] {
        RenderOptions options = parse_render_options(argc, argv, "11_light_importance",
                                                     {"scenes/thousand-lights.pbrt", 16});
        Scene scene = load(options, features_of(11));
        return render(scene, options, method_of<ch11::trace>(ch11::prepare(scene)));
    });
}

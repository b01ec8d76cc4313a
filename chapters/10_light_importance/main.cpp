// Chapter 10 as a program: reads options, loads a scene, renders it, writes the picture.
#include "chapters/10_light_importance/estimator.h"
#include "common/program/render.h"

int main(int argc, char** argv) {
    return run_program([&] {
        RenderOptions options =
            parse_render_options(argc, argv, "10_light_importance", "scenes/thousand-lights.pbrt");
        Scene scene = load(options);
        refuse_glossy(scene);
        return render(scene, options, trace_with<ch10::trace>(ch10::prepare(scene)));
    });
}

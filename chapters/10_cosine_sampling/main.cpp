// Chapter 10 as a program: reads options, loads a scene, renders it, writes the picture.
#include "chapters/10_cosine_sampling/estimator.h"
#include "common/render/program.h"

int main(int argc, char** argv) {
    return run_program([&] {
        RenderOptions options =
            parse_render_options(argc, argv, "10_cosine_sampling", {"scenes/cornell.pbrt", 16});
        Scene scene = load(options, features_of(10));
        return render(scene, options, method_of<ch10::trace>());
    });
}

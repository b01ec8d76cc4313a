// Chapter 12 as a program: reads options, loads a scene, renders it, writes the picture.
#include "chapters/12_ris/estimator.h"
#include "common/render/program.h"

int main(int argc, char** argv) {
    return run_program([&] {
        int M = 16;
        Option candidates =
            whole_option("m", "M", "light candidates for each shadow ray", 1, 1024, M);
        RenderOptions options = parse_render_options(
            argc, argv, "12_ris", {"scenes/thousand-lights.pbrt", 16}, {candidates});
        Scene scene = load(options, features_of(12));
        return render(scene, options, method_of<ch12::trace>(ch12::prepare(scene, M)));
    });
}

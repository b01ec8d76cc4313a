// Chapter 18 as a program: reads options, loads a scene, renders it, writes the picture.
#include "chapters/18_dispersion/estimator.h"
#include "common/render/program.h"

int main(int argc, char** argv) {
    return run_program([&] {
        int M = 64;
        Option candidates = whole_option("m", "M", "light candidates, at most one per light", 1,
                                         ch18::Candidates::most, M);
        RenderOptions options = parse_render_options(argc, argv, "18_dispersion",
                                                     {"scenes/prism.pbrt", 16}, {candidates});
        Scene scene = load(options, features_of(18));
        return render(scene, options,
                      method_of<ch18::trace>(ch18::prepare(scene, M), shares_of_white()));
    });
}

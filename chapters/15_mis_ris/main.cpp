// Chapter 15 as a program: reads options, loads a scene, renders it, writes the picture.
#include "chapters/15_mis_ris/estimator.h"
#include "common/render/program.h"

int main(int argc, char** argv) {
    return run_program([&] {
        int M = 64;
        Option candidates = whole_option("m", "M", "light candidates, at most one per light", 1,
                                         ch15::Candidates::most, M);
        RenderOptions options = parse_render_options(
            argc, argv, "15_mis_ris", {"scenes/thousand-lights.pbrt", 16}, {candidates});
        Scene scene = load(options, features_of(15));
        return render(scene, options, method_of<ch15::trace>(ch15::prepare(scene, M)));
    });
}

// Chapter 17 as a program: reads options, loads a scene, renders it, writes the picture.
#include "chapters/17_sky_image/estimator.h"
#include "common/render/program.h"

int main(int argc, char** argv) {
    return run_program([&] {
        int M = 64;
        bool compensate = true;
        Option candidates = whole_option("m", "M", "light candidates, at most one per light", 1,
                                         ch17::Candidates::most, M);
        Option sky = choice_option(
            "compensation", "on|off",
            "sample pixels of the sky's image by their excess over its mean (default), "
            "or by all of their light",
            {"off", "on"}, compensate);
        RenderOptions options = parse_render_options(argc, argv, "17_sky_image",
                                                     {"scenes/sky.pbrt", 16}, {candidates, sky});
        Scene scene = load(options, features_of(17));
        return render(scene, options, method_of<ch17::trace>(ch17::prepare(scene, M, compensate)));
    });
}

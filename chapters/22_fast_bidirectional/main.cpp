// Chapter 22 as a program: reads options, loads a scene, renders it, writes the picture.
#include "chapters/22_fast_bidirectional/estimator.h"
#include "common/render/program.h"

int main(int argc, char** argv) {
    return run_program([&] {
        int samples = 16;
        bool light_sampling = true;
        Option extra_samples =
            whole_option("extra-samples", "N", "more samples of light that only random hits find",
                         0, 1000, samples);
        Option direct_by = choice_option(
            "direct-by", "CHAPTER", "how direct light is found: as in chapter 15 (default) or 21",
            {"21", "15"}, light_sampling);
        RenderOptions options =
            parse_render_options(argc, argv, "22_fast_bidirectional",
                                 {"scenes/cornell-spheres.pbrt", 16}, {extra_samples, direct_by});
        options.search = LightSearch::both_ends;
        Scene scene = load(options, features_of(22));
        return render(scene, options,
                      method_of<ch22::trace>(ch22::prepare(scene, samples, light_sampling)));
    });
}

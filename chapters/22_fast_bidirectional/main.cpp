// Chapter 22 as a program: reads options, loads a scene, renders it, writes the picture.
#include "chapters/22_fast_bidirectional/estimator.h"
#include "common/program/render.h"

int main(int argc, char** argv) {
    return run_program([&] {
        int chances = 16;
        Option option = {"chances", "N",
                         "samples where mirrors and glass leave only chance; 0: as in chapter 21",
                         [&](const std::string& text) {
                             chances = static_cast<int>(parse_integer("chances", text, 0, 1000));
                         },
                         "16"};
        RenderOptions options = parse_render_options(argc, argv, "22_fast_bidirectional",
                                                     "scenes/cornell-spheres.pbrt", {option});
        options.search = LightSearch::both_ends;
        Scene scene = load(options);
        return render(scene, options, splat_trace_with<ch22::trace>(ch22::prepare(scene, chances)));
    });
}

// Chapter 06 as a program: measures its steps in a table, and draws the work of one as a heat map.
#include "chapters/06_bvh/figure.h"
#include "common/render/render.h"

int main(int argc, char** argv) {
    return run_program([&] {
        ch06::Step step = ch06::Step::ordered;
        Option which =
            choice_option("step", "STEP", "drawn: linear, median, sah, ordered (default) or four",
                          ch06::step_names, step);
        RenderOptions options = parse_render_options(argc, argv, "06_bvh", {"scenes/knot.pbrt", 0},
                                                     {which}, {"size", "threads", "out", "quiet"});
        Scene scene = load(options, features_of(6));
        Table table;
        if (!options.quiet) table = ch06::steps_table(scene);
        FilmLabel label = label_of(scene, options);
        label.samples.clear();  // it has none
        write_results({comment_of(notes_of(label, 0)), 0, 0, options.out, options.quiet}, table,
                      "white: 200 boxes and primitives for one ray\n",
                      ch06::work_picture(scene, step));
        return 0;
    });
}

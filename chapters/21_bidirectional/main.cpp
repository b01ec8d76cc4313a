// Chapter 21 as a program: reads options, loads a scene, renders it, writes the picture.
#include "chapters/21_bidirectional/estimator.h"
#include "chapters/21_bidirectional/figure.h"
#include "common/render/program.h"

int main(int argc, char** argv) {
    return run_program([&] {
        std::string alone, sheet;
        Option strategy = {"strategy", "S,T",
                           "only one, without weight: S vertices from the light, T the eye",
                           [&](const std::string& text) {
                               std::vector<int> ends = split_numbers(text, ',');
                               if (ends.size() != 2 || ends[1] < 1 || ends[0] + ends[1] < 2)
                                   fail_value("strategy", text, "S,T, such as 2,2");
                               alone = ch21::strategy_name(ends[0], ends[1]);
                           },
                           "all"};
        Option pyramid =
            text_option("pyramid", "FILE", "also write all short strategies as one sheet", sheet);
        RenderOptions options =
            parse_render_options(argc, argv, "21_bidirectional", {"scenes/cornell-spheres.pbrt", 8},
                                 {strategy, pyramid});
        options.search = LightSearch::both_ends;
        options.strategy = alone, options.unweighted = !alone.empty();
        Scene scene = load(options, features_of(21));
        if (!sheet.empty())
            write_image(sheet, ch21::pyramid(scene, options),
                        comment_of(notes_of(label_of(scene, options), scene.spp)));
        return render(scene, options, method_of<ch21::trace>(endpoints_of(scene)));
    });
}

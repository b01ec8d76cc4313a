// Chapter 18 as a program: reads options, loads a scene, renders it, writes the picture.
#include "chapters/18_bidirectional/estimator.h"
#include "common/program/render.h"

int main(int argc, char** argv) {
    return run_program([&] {
        int s = -1, t = -1;
        Option strategy = {
            "strategy", "S,T", "one strategy alone, without a weight: S vertices from the light",
            [&](const std::string& text) {
                size_t comma = std::min(text.find(','), text.size() - 1);
                s = static_cast<int>(parse_integer("strategy", text.substr(0, comma), 0, 1000));
                t = static_cast<int>(parse_integer("strategy", text.substr(comma + 1), 1, 1000));
            },
            "all"};
        RenderOptions options = parse_render_options(argc, argv, "18_bidirectional",
                                                     "scenes/cornell-spheres.pbrt", {strategy});
        options.search = LightSearch::both_ends;
        Scene scene = load(options);
        return render(scene, options, splat_trace_with<ch18::trace>(ch18::prepare(scene, s, t)));
    });
}

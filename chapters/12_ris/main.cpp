// Chapter 12 as a program: reads options, loads a scene, renders it, writes the picture.
#include "chapters/12_ris/estimator.h"
#include "common/program/render.h"

int main(int argc, char** argv) {
    return run_program([&] {
        int M = 16;
        Option candidates = {"m", "M", "light candidates for each shadow ray (default 16)",
                             [&](const std::string& text) {
                                 M = static_cast<int>(parse_integer("m", text, 1, 1024));
                             },
                             "16"};
        RenderOptions options =
            parse_render_options(argc, argv, "12_ris", "scenes/thousand-lights.pbrt", {candidates});
        Scene scene = load(options);
        refuse_glossy(scene);
        return render(scene, options, method_of<ch12::trace>(ch12::prepare(scene, M)));
    });
}

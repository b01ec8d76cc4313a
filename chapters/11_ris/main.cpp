// Chapter 11 as a program: reads options, loads a scene, renders it, writes the picture.
#include "chapters/11_ris/estimator.h"
#include "common/program/render.h"

int main(int argc, char** argv) {
    return run_program([&] {
        Option candidates = {"m", "M", "light candidates for each shadow ray (default 16)",
                             [](const std::string& text) {
                                 ch11::M = static_cast<int>(parse_integer("m", text, 1, 1024));
                             }};
        RenderOptions options =
            parse_render_options(argc, argv, "11_ris", "scenes/thousand-lights.pbrt", {candidates});
        Scene scene = load(options);
        refuse_glossy(scene);
        ch11::prepare(scene);
        return render(scene, options, ch11::trace);
    });
}

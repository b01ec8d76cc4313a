// Chapter 16 as a program: reads options, loads a scene, renders it, writes the picture.
#include "chapters/16_lens_and_shutter/estimator.h"
#include "common/program/render.h"

int main(int argc, char** argv) {
    return run_program([&] {
        int M = 64;
        bool centre = false;
        Option candidates = {
            "m", "M", "light candidates, at most one per light (default 64)",
            [&](const std::string& text) {
                M = static_cast<int>(parse_integer("m", text, 1, ch16::Candidates::most));
            },
            "64"};
        Option pixel = {"pixel", "area|centre",
                        "average over each pixel (default), or only its centre",
                        [&](const std::string& text) {
                            centre = parse_choice("pixel", text, {"area", "centre"}) == 1;
                        },
                        "area"};
        RenderOptions options = parse_render_options(argc, argv, "16_lens_and_shutter",
                                                     "scenes/bokeh.pbrt", {candidates, pixel});
        Scene scene = load(options, features_of(16));
        scene.camera.pixel_centre = centre;
        return render(scene, options, method_of<ch16::trace>(ch16::prepare(scene, M)));
    });
}

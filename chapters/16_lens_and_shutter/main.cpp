// Chapter 16 as a program: reads options, loads a scene, renders it, writes the picture.
#include "chapters/16_lens_and_shutter/estimator.h"
#include "common/render/program.h"

int main(int argc, char** argv) {
    return run_program([&] {
        int M = 64;
        bool centre = false;
        Option candidates = whole_option("m", "M", "light candidates, at most one per light", 1,
                                         ch16::Candidates::most, M);
        Option pixel = choice_option("pixel", "area|centre",
                                     "average over each pixel (default), or only its centre",
                                     {"area", "centre"}, centre);
        RenderOptions options = parse_render_options(
            argc, argv, "16_lens_and_shutter", {"scenes/bokeh.pbrt", 32}, {candidates, pixel});
        Scene scene = load(options, features_of(16));
        scene.camera.pixel_centre = centre;
        return render(scene, options, method_of<ch16::trace>(ch16::prepare(scene, M)));
    });
}

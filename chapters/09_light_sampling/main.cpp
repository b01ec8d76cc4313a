// Chapter 09 as a program: reads options, loads a scene, renders it, writes the picture.
#include "chapters/09_light_sampling/estimator.h"
#include "common/render/program.h"

int main(int argc, char** argv) {
    return run_program([&] {
        auto measure = ch09::LightMeasure::solid_angle;
        Option light_by =
            choice_option("light-by", "MEASURE", "draw points of lights by area or by solid-angle",
                          {"area", "solid-angle"}, measure);
        RenderOptions options = parse_render_options(argc, argv, "09_light_sampling",
                                                     {"scenes/cornell.pbrt", 16}, {light_by});
        Scene scene = load(options, features_of(9));
        return render(scene, options, method_of<ch09::trace>(measure));
    });
}

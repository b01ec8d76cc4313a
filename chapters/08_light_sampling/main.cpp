// Chapter 08 as a program: reads options, loads a scene, renders it, writes the picture.
#include "chapters/08_light_sampling/estimator.h"
#include "common/program/render.h"

int main(int argc, char** argv) {
    return run_program([&] {
        auto measure = ch08::LightMeasure::solid_angle;
        Option light_by = {"light-by", "MEASURE", "draw points of lights by area or by solid-angle",
                           [&](const std::string& text) {
                               measure = static_cast<ch08::LightMeasure>(
                                   parse_choice("light-by", text, {"area", "solid-angle"}));
                           },
                           "solid-angle"};
        RenderOptions options = parse_render_options(argc, argv, "08_light_sampling",
                                                     "scenes/cornell.pbrt", {light_by});
        Scene scene = load(options);
        refuse_glossy(scene);
        return render(scene, options, trace_with<ch08::trace>(measure));
    });
}

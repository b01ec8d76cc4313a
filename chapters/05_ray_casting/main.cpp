// Chapter 05 as a program: reads options, loads a scene, renders it, writes the picture.
#include "chapters/05_ray_casting/estimator.h"
#include "common/render/program.h"

int main(int argc, char** argv) {
    return run_program([&] {
        RenderOptions options =
            parse_render_options(argc, argv, "05_ray_casting", {"scenes/cornell-spheres.pbrt", 16});
        options.search = LightSearch::direct;
        Scene scene = load(options, features_of(5));
        scene.max_depth = std::min(scene.max_depth, 500);  // trace() calls itself at each mirror
        return render(scene, options, ch05::trace);
    });
}

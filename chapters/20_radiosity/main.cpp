// Chapter 20 as a program: reads options, loads a scene, solves it, writes the picture.
#include "chapters/20_radiosity/run.h"

int main(int argc, char** argv) {
    return run_program([&] {
        ch20::Settings settings;
        std::vector<Option> own = ch20::own_options(settings);
        RenderOptions options =
            parse_render_options(argc, argv, "20_radiosity", "scenes/cornell.pbrt", own,
                                 {"spp", "time", "size", "seed", "threads", "sampler", "out",
                                  "stats", "film", "film-every", "quiet"});
        ch20::check_together(options, settings);
        Scene scene = load(options);
        bool has_noise = settings.show == Show::gather;
        if (options.spp == 0 && !has_noise) scene.spp = std::min(scene.spp, 16);  // for edges alone
        refuse(scene);
        settings.patches += tessellate(scene, options.threads);
        ch20::check_all_outputs(scene, options, settings);
        return ch20::Run(scene, options, settings).run();
    });
}

// Chapter 26 as a program: reads options, loads a scene, solves it, writes the picture.
#include "chapters/26_radiosity/run.h"

int main(int argc, char** argv) {
    return run_program([&] {
        ch26::Settings settings;
        std::vector<Option> own = ch26::own_options(settings);
        RenderOptions options =
            parse_render_options(argc, argv, "26_radiosity", "scenes/cornell.pbrt", own,
                                 {"spp", "time", "size", "seed", "threads", "sampler", "out",
                                  "stats", "film", "film-every", "stand-in", "quiet"});
        ch26::check_together(options, settings);
        Scene scene = load(options);
        bool has_noise = settings.show == ch26::Show::gather;
        if (options.spp == 0 && !has_noise) scene.spp = std::min(scene.spp, 16);  // for edges alone
        refuse(scene);
        settings.patches += ch26::tessellate(scene, options.threads);
        ch26::check_all_outputs(scene, options, settings);
        return ch26::Run(scene, options, settings).run();
    });
}

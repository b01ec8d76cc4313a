// Chapter 25 as a program: reads options, loads a scene, renders it, writes the picture.
#include "chapters/25_vertex_merging/estimator.h"
#include "common/render/program.h"

int main(int argc, char** argv) {
    return run_program([&] {
        PhotonSettings s;
        double radius = 0;
        s.light_paths = 0;
        std::vector<Option> extra = {whole_option("photons", "N",
                                                  "light paths in each pass that may merge; 0: two "
                                                  "for each pixel, at most a million (default)",
                                                  0, 1'000'000, s.light_paths),
                                     positive_option("radius", "METRES",
                                                     "radius of the disk in which paths merge, in "
                                                     "the first pass (default 0: by photons)",
                                                     radius, true)};
        RenderOptions options =
            parse_render_options(argc, argv, "25_vertex_merging", {"scenes/sds.pbrt", 16}, extra);
        options.search = LightSearch::merging;
        Scene scene = load(options, features_of(25));
        s.radius = static_cast<float>(radius);
        s.sampler = options.sampler, s.seed = options.seed;
        return render(scene, options, ch25::merging_passes(scene, s));
    });
}

// Chapter 24 as a program: reads options, loads a scene, renders it, writes the picture.
#include "chapters/24_progressive_photons/estimator.h"
#include "common/render/program.h"

int main(int argc, char** argv) {
    return run_program([&] {
        PhotonSettings s;
        double radius = 0;
        std::vector<Option> extra = {
            whole_option("photons", "N", "light paths in each pass", 1, 1'000'000, s.light_paths),
            choice_option(
                "gather", "final|direct",
                "gather photons after one more diffuse bounce (default), or at the visible point",
                {"direct", "final"}, s.final_gathering),
            positive_option("radius", "METRES",
                            "radius of the disk in which photons count, in the first pass (default "
                            "0: by photons)",
                            radius, true)};
        RenderOptions options = parse_render_options(argc, argv, "24_progressive_photons",
                                                     {"scenes/pool.pbrt", 24}, extra);
        options.search = LightSearch::photons;
        Scene scene = load(options, features_of(24));
        s.radius = static_cast<float>(radius);
        s.sampler = options.sampler, s.seed = options.seed;
        return render(scene, options, ch24::photon_passes(scene, s));
    });
}

// Chapter 24 as a program: reads options, loads a scene, renders it, writes the picture.
#include "chapters/24_progressive_photons/estimator.h"
#include "common/program/render.h"

int main(int argc, char** argv) {
    return run_program([&] {
        PhotonSettings s;
        double radius = 0;
        std::vector<Option> extra = {
            {"photons", "N", "light paths in each pass (default 100000)",
             [&](const std::string& text) {
                 s.light_paths = static_cast<int>(parse_integer("photons", text, 1, 1'000'000));
             },
             "100000"},
            {"gather", "final|direct",
             "gather photons after one more diffuse bounce (default), or at the visible point",
             [&](const std::string& text) {
                 s.final_gathering = parse_choice("gather", text, {"direct", "final"}) == 1;
             },
             "final"},
            {"radius", "METRES",
             "radius of the disk in which photons count, in the first pass (default 0: by "
             "photons)",
             [&](const std::string& text) {
                 radius = text == "0" ? 0 : parse_positive("radius", text);
             },
             "0"}};
        RenderOptions options = parse_render_options(argc, argv, "24_progressive_photons",
                                                     "scenes/pool.pbrt", std::move(extra));
        options.search = LightSearch::photons;
        Scene scene = load(options, features_of(24));
        s.radius = radius_within(scene, radius);
        s.sampler = options.sampler, s.seed = options.seed;
        return render(scene, options, ch24::photon_passes(scene, s));
    });
}

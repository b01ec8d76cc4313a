// Chapter 23 as a program: reads options, loads a scene, renders it, writes the picture.
#include "chapters/23_photon_mapping/estimator.h"
#include "common/program/render.h"

int main(int argc, char** argv) {
    return run_program([&] {
        ch23::Settings s;
        std::vector<Option> extra = {
            {"photons", "N", "paths from lights in each pass (default 100000)",
             [&](const std::string& text) {
                 s.photons = static_cast<int>(parse_integer("photons", text, 1, 1'000'000));
             },
             "100000"},
            {"gather", "final|direct|nearest",
             "count photons one diffuse bounce on; where the eye looks; or there, k nearest",
             [&](const std::string& text) {
                 auto i = parse_choice("gather", text, {"nearest", "direct", "final"});
                 s.gather = static_cast<ch23::Gather>(i);
             },
             "final"},
            {"nearest", "K", "photons that the radius is to hold at first (default 50)",
             [&](const std::string& text) {
                 s.k = static_cast<size_t>(parse_integer("nearest", text, 3, 10'000));
             },
             "50"},
            {"kernel", "box|cone|epanechnikov", "how photons count by distance",
             [&](const std::string& text) {
                 auto i = parse_choice("kernel", text, {"box", "cone", "epanechnikov"});
                 s.kernel = static_cast<ch23::Kernel>(i);
             },
             "epanechnikov"}};
        RenderOptions options = parse_render_options(argc, argv, "23_photon_mapping",
                                                     "scenes/pool.pbrt", std::move(extra));
        options.search = LightSearch::photons;
        Scene scene = load(options);
        s.sampler = options.sampler, s.seed = options.seed;
        return render(scene, options, ch23::photon_passes(scene, s));
    });
}

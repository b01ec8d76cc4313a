// Chapter 19 as a program: reads options, loads a scene, renders it, writes the picture.
#include "chapters/19_adaptive/estimator.h"
#include "common/base/files.h"
#include "common/picture/drawing.h"
#include "common/render/program.h"

int main(int argc, char** argv) {
    return run_program([&] {
        ch19::SampleDensities densities;
        std::string map;
        Option pilot = whole_option("pilot", "N", "samples of each pixel in the pilot", 4, 1 << 16,
                                    densities.pilot);
        Option pilot_half = choice_option(
            "pilot-half", "other|own",
            "which half's pilot decides about a half: the other (default), or its own, "
            "which is biased",
            {"other", "own"}, densities.pilot_half);
        Option counts = {"map", "FILE",
                         "picture of the number of samples of each pixel (.pfm: numbers)",
                         [&](const std::string& text) { map = parse_picture("map", text); }};
        RenderOptions options =
            parse_render_options(argc, argv, "19_adaptive", {"scenes/high-contrast.pbrt", 32},
                                 {pilot, pilot_half, counts});
        auto counts_of = [&](const Film& film) {
            float most = 4 * static_cast<float>(film.spp());
            return has_ending(map, ".pfm") ? film.counts() : heat_map(film.counts(), most);
        };
        if (!map.empty()) options.pictures = {{map, counts_of}};
        Scene scene = load(options, features_of(19));
        Method method = method_of<ch19::trace>(ch19::prepare(scene), shares_of_white());
        method.allocation = ch19::allocation(densities);
        return render(scene, options, method);
    });
}

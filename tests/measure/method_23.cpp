#include "chapters/23_photon_mapping/estimator.h"
#include "tests/measure/methods.h"

static auto by_photons(ch23::Gather gather, int photons = ch23::Settings().photons) {
    return [=](const Scene& scene, RenderOptions options) {
        options.search = LightSearch::photons;
        ch23::Settings settings;
        settings.sampler = options.sampler, settings.seed = options.seed;
        settings.gather = gather, settings.photons = photons;
        return render_film(scene, options, ch23::photon_passes(scene, settings));
    };
}

[[maybe_unused]] static const bool added = [] {
    add_method({.name = "23-direct",
                .label = "23, photons where the eye looks",
                .color = "#006655",
                .finds_light = "by photons",
                .render = by_photons(ch23::Gather::direct),
                .biased = true});
    add_method({.name = "23-few",
                .label = "23 with few photons",
                .color = "#66dfc0",
                .finds_light = "by photons",
                .render = by_photons(ch23::Gather::final, 200),
                .biased = true});
    return add_method({.name = "23",
                       .label = "23 photon mapping",
                       .color = "#00c896",
                       .finds_light = "by photons",
                       .scenes = {"pool", "sds", "cornell-spheres"},
                       .render = by_photons(ch23::Gather::final),
                       .biased = true});
}();

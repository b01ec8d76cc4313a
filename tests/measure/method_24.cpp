#include "chapters/24_progressive_photons/estimator.h"
#include "tests/measure/methods.h"

static auto by_photons(PhotonSettings settings) {
    return [=](const Scene& scene, const RenderOptions& options) {
        PhotonSettings own = settings;
        own.sampler = options.sampler, own.seed = options.seed;
        return render_film(scene, options, ch24::photon_passes(scene, own));
    };
}

[[maybe_unused]] static const bool added = [] {
    add_method({.name = "24-few",
                .label = "24 with few photons",
                .color = "#c8df66",
                .finds_light = "by photons",
                .render = by_photons({.light_paths = 200, .radius = 0.015f}),
                .biased = true,
                .search = LightSearch::photons});
    return add_method({.name = "24",
                       .label = "24 progressive photons",
                       .color = "#8fae00",
                       .finds_light = "by photons",
                       .scenes = {"pool", "sds", "cornell-spheres"},
                       .render = by_photons({}),
                       .biased = true,
                       .search = LightSearch::photons});
}();

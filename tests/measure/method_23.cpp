#include "chapters/23_photon_mapping/estimator.h"
#include "tests/measure/methods.h"

static auto by_photons(ch23::PhotonSettings settings) {
    return [=](const Scene& scene, const RenderOptions& options) {
        ch23::PhotonSettings own = settings;
        own.sampler = options.sampler, own.seed = options.seed;
        return render_film(scene, options, ch23::photon_passes(scene, own));
    };
}

[[maybe_unused]] static const bool added = [] {
    add_method({.name = "23-few",
                .label = "23 with few photons",
                .color = "#66dfc0",
                .finds_light = "by photons",
                .render = by_photons({.light_paths = 200, .radius = 0.01f}),
                .biased = true,
                .search = LightSearch::photons});
    return add_method({.name = "23",
                       .label = "23 photon mapping",
                       .color = "#00c896",
                       .finds_light = "by photons",
                       .scenes = {"pool", "sds", "cornell-spheres"},
                       .render = by_photons({}),
                       .biased = true,
                       .search = LightSearch::photons});
}();

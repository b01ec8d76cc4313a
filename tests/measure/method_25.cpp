#include "chapters/25_vertex_merging/estimator.h"
#include "tests/measure/methods.h"

static auto by_merging(PhotonSettings settings) {
    return [=](const Scene& scene, RenderOptions options) {
        if (settings.sampler != SamplerType::independent) options.sampler = settings.sampler;
        PhotonSettings own = settings;
        own.sampler = options.sampler, own.seed = options.seed;
        return render_film(scene, options, ch25::merging_passes(scene, own));
    };
}

[[maybe_unused]] static const bool added = [] {
    add_method({.name = "25-few",
                .label = "25 with few photons",
                .color = "#e0c878",
                .finds_light = "by photons from both ends",
                .render = by_merging({.light_paths = 200, .radius = 0.02f}),
                .biased = true,
                .search = LightSearch::merging});
    add_method({.name = "25-sobol",
                .label = "25, Sobol",
                .color = "#e7ba52",
                .finds_light = "by photons from both ends",
                .render = by_merging({.sampler = SamplerType::sobol, .light_paths = 0}),
                .biased = true,
                .search = LightSearch::merging});
    return add_method({.name = "25",
                       .label = "25 vertex merging",
                       .color = "#b8860b",
                       .finds_light = "by photons from both ends",
                       .scenes = {"sds", "caustic", "cornell-spheres"},
                       .render = by_merging({.light_paths = 0}),
                       .biased = true,
                       .search = LightSearch::merging});
}();

#include "chapters/25_vertex_merging/estimator.h"
#include "tests/methods/table.h"

static NamedMethod row(const char* name, const char* label, const char* color,
                       PhotonSettings settings) {
    return {.name = name,
            .label = label,
            .color = color,
            .scenes = {"sds", "caustic", "cornell-spheres"},
            .search = LightSearch::merging,
            .make = [=](const Scene& scene, RenderOptions& options) mutable {
                if (settings.sampler != SamplerType::independent)
                    options.sampler = settings.sampler;
                settings.sampler = options.sampler, settings.seed = options.seed;
                return ch25::merging_passes(scene, settings);
            }};
}
static const Rows added = {
    row("25", "25 vertex merging", "#b8860b", {.light_paths = 0}),
    row("25-few", "25 with few photons", "#e0c878", {.light_paths = 200, .radius = 0.02f}),
    row("25-sobol", "25, Sobol", "#e7ba52", {.sampler = SamplerType::sobol, .light_paths = 0})};

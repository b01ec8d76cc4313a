#include "chapters/23_photon_mapping/estimator.h"
#include "tests/methods/table.h"

static NamedMethod row(const char* name, const char* label, const char* color,
                       ch23::PhotonSettings settings) {
    return {.name = name,
            .label = label,
            .color = color,
            .scenes = {"pool", "sds", "cornell-spheres"},
            .search = LightSearch::photons,
            .make = [=](const Scene& scene, RenderOptions& options) mutable {
                settings.sampler = options.sampler, settings.seed = options.seed;
                return ch23::photon_passes(scene, settings);
            }};
}
static const Rows added = {
    row("23", "23 photon mapping", "#00c896", {}),
    row("23-few", "23 with few photons", "#66dfc0", {.light_paths = 200, .radius = 0.01f})};

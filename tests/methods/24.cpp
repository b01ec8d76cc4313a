#include "chapters/24_progressive_photons/estimator.h"
#include "tests/methods/table.h"

static NamedMethod row(const char* name, const char* label, const char* color,
                       PhotonSettings settings) {
    return {.name = name,
            .label = label,
            .color = color,
            .scenes = {"pool", "sds", "cornell-spheres"},
            .search = LightSearch::photons,
            .make = [=](const Scene& scene, RenderOptions& options) mutable {
                settings.sampler = options.sampler, settings.seed = options.seed;
                return ch24::photon_passes(scene, settings);
            }};
}
static const Rows added = {
    row("24", "24 progressive photons", "#8fae00", {}),
    row("24-few", "24 with few photons", "#c8df66", {.light_paths = 200, .radius = 0.015f})};

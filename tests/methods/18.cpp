#include "chapters/18_dispersion/estimator.h"
#include "tests/methods/table.h"

static NamedMethod row(const char* name, const char* label, const char* color,
                       SamplerType sampler = SamplerType::independent) {
    return {.name = name,
            .label = label,
            .color = color,
            .scenes = {"prism"},
            .make = [=](const Scene& scene, RenderOptions& options) {
                if (sampler != SamplerType::independent) options.sampler = sampler;
                return method_of<ch18::trace>(ch18::prepare(scene), shares_of_white());
            }};
}
static const Rows added = {row("18", "18 dispersion", "#54278f"),
                           row("18-sobol", "18, Sobol", "#bcbddc", SamplerType::sobol)};

#include "chapters/17_sky_image/estimator.h"
#include "tests/methods/table.h"

static NamedMethod row(const char* name, const char* label, const char* color,
                       SamplerType sampler = SamplerType::independent, bool compensate = true) {
    return {.name = name,
            .label = label,
            .color = color,
            .scenes = {"sky"},
            .make = [=](const Scene& scene, RenderOptions& options) {
                if (sampler != SamplerType::independent) options.sampler = sampler;
                return method_of<ch17::trace>(ch17::prepare(scene, 64, compensate));
            }};
}
static const Rows added = {
    row("17", "17 image of the sky", "#2b8cbe"),
    row("17-plain", "17, no compensation", "#a6bddb", SamplerType::independent, false),
    row("17-sobol", "17, Sobol", "#a8ddb5", SamplerType::sobol)};

#include "chapters/16_lens_and_shutter/estimator.h"
#include "tests/methods/table.h"

static NamedMethod row(const char* name, const char* label, const char* color,
                       SamplerType sampler = SamplerType::independent) {
    return {.name = name,
            .label = label,
            .color = color,
            .scenes = {"bokeh", "moving-ball"},
            .make = [=](const Scene& scene, RenderOptions& options) {
                if (sampler != SamplerType::independent) options.sampler = sampler;
                return method_of<ch16::trace>(ch16::prepare(scene));
            }};
}
static const Rows added = {row("16", "16 lens and shutter", "#0000ff"),
                           row("16-sobol", "16, Sobol", "#9edae5", SamplerType::sobol)};

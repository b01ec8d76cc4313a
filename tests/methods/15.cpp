#include "chapters/15_mis_ris/estimator.h"
#include "tests/methods/table.h"

static NamedMethod row(const char* name, const char* label, const char* color, int M = 64,
                       SamplerType sampler = SamplerType::independent) {
    return {.name = name,
            .label = label,
            .color = color,
            .scenes = {"thousand-lights", "two-lights", "hidden-light", "veach-mis"},
            .make = [=](const Scene& scene, RenderOptions& options) {
                if (sampler != SamplerType::independent) options.sampler = sampler;
                return method_of<ch15::trace>(ch15::prepare(scene, M));
            }};
}
static const Rows added = {
    row("15", "15 MIS with RIS", "#d62728"),
    row("15-m16", "15 MIS with RIS, M = 16", "#7f0000", 16),
    row("15-sobol", "15 MIS with RIS, Sobol", "#393b79", 64, SamplerType::sobol)};

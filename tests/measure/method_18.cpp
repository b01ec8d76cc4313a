#include "chapters/18_bidirectional/estimator.h"
#include "tests/measure/methods.h"

static Method method(const char* name, const char* label, const char* color, SamplerType sampler) {
    return {.name = name,
            .label = label,
            .color = color,
            .finds_light = "from both ends",
            .scenes = {"cornell-spheres", "cornell", "lamp"},
            .render = [=](const Scene& scene, RenderOptions options) {
                options.search = LightSearch::both_ends;
                if (sampler != SamplerType::independent) options.sampler = sampler;
                return render_film(scene, options,
                                   splat_trace_with<ch18::trace>(ch18::prepare(scene)));
            }};
}

[[maybe_unused]] static const bool added[] = {
    add_method(method("18", "18 bidirectional", "#e377c2", SamplerType::independent)),
    add_method(method("18-sobol", "18, Sobol", "#f7b6d2", SamplerType::sobol)),
};

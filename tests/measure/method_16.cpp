#include "chapters/16_lens_and_shutter/estimator.h"
#include "tests/measure/methods.h"

static NamedMethod method(const char* name, const char* label, const char* color,
                          SamplerType sampler) {
    auto render =
        by_trace([](const Scene& scene) { return method_of<ch16::trace>(ch16::prepare(scene)); });
    return {.name = name,
            .label = label,
            .color = color,
            .finds_light = "both ways",
            .scenes = {"bokeh", "moving-ball"},
            .render =
                [=](const Scene& scene, RenderOptions options) {
                    if (sampler != SamplerType::independent) options.sampler = sampler;
                    return render(scene, options);
                },
            .features = features_of(16)};
}

[[maybe_unused]] static const bool added[] = {
    add_method(method("16", "16 lens and shutter", "#0000ff", SamplerType::independent)),
    add_method(method("16-sobol", "16, Sobol", "#9edae5", SamplerType::sobol)),
};

#include "chapters/17_sky_image/estimator.h"
#include "tests/measure/methods.h"

static NamedMethod method(const char* name, const char* label, const char* color,
                          SamplerType sampler = SamplerType::independent, bool compensate = true) {
    auto render = by_trace([=](const Scene& scene) {
        return method_of<ch17::trace>(ch17::prepare(scene, 64, compensate));
    });
    return {.name = name,
            .label = label,
            .color = color,
            .finds_light = "both ways",
            .scenes = {"sky"},
            .render =
                [=](const Scene& scene, RenderOptions options) {
                    if (sampler != SamplerType::independent) options.sampler = sampler;
                    return render(scene, options);
                },
            .features = features_of(17)};
}

[[maybe_unused]] static const bool added[] = {
    add_method(method("17", "17 image of the sky", "#2b8cbe")),
    add_method(
        method("17-plain", "17, no compensation", "#a6bddb", SamplerType::independent, false)),
    add_method(method("17-sobol", "17, Sobol", "#a8ddb5", SamplerType::sobol)),
};

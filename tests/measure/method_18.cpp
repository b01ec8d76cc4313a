#include "chapters/18_dispersion/estimator.h"
#include "tests/measure/methods.h"

static NamedMethod method(const char* name, const char* label, const char* color,
                          SamplerType sampler) {
    auto render = by_trace([](const Scene& scene) {
        return method_of<ch18::trace>(ch18::prepare(scene), shares_of_white());
    });
    return {.name = name,
            .label = label,
            .color = color,
            .finds_light = "both ways",
            .scenes = {"prism"},
            .render =
                [=](const Scene& scene, RenderOptions options) {
                    if (sampler != SamplerType::independent) options.sampler = sampler;
                    return render(scene, options);
                },
            .features = features_of(18)};
}

[[maybe_unused]] static const bool added[] = {
    add_method(method("18", "18 dispersion", "#54278f", SamplerType::independent)),
    add_method(method("18-sobol", "18, Sobol", "#bcbddc", SamplerType::sobol)),
};

#include "chapters/16_distribution/estimator.h"
#include "tests/measure/chance_16.h"
#include "tests/measure/methods.h"

static Method method(const char* name, const char* label, const char* color, SamplerType sampler) {
    auto render =
        by_trace([](const Scene& scene) { return trace_with<ch16::trace>(ch16::prepare(scene)); });
    return {.name = name,
            .label = label,
            .color = color,
            .finds_light = "both ways",
            .scenes = {"sky", "bokeh", "moving-ball"},
            .render =
                [=](const Scene& scene, RenderOptions options) {
                    if (sampler != SamplerType::independent) options.sampler = sampler;
                    return render(scene, options);
                },
            .has_distribution = true};
}

static Method by_chance() {
    return {.name = "16-chance",
            .label = "16, light by chance",
            .color = "#0077ff",
            .finds_light = "by chance",
            .refuse = {refuse_delta_lights},
            .render = by_trace([](const Scene&) -> Trace {
                return [white = shares_of_white()](const Scene& scene, Ray ray, Sampler& sampler,
                                                   Recorder& recorder) {
                    return trace_by_chance(scene, white, ray, sampler, recorder);
                };
            }),
            .has_distribution = true};
}

[[maybe_unused]] static const bool added[] = {
    add_method(method("16", "16 lens, time, color, sky", "#0000ff", SamplerType::independent)),
    add_method(by_chance()),
    add_method(method("16-sobol", "16, Sobol", "#9edae5", SamplerType::sobol)),
};

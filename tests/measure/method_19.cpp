#include "chapters/19_adaptive/estimator.h"
#include "tests/measure/methods.h"

static Method method(const char* name, const char* label, const char* color, SamplerType sampler,
                     ch19::Judge judge = ch19::Judge::other) {
    return {.name = name,
            .label = label,
            .color = color,
            .finds_light = "both ways",
            .scenes = {"high-contrast", "cornell-spheres", "cornell"},
            .render =
                [=](const Scene& scene, RenderOptions options) {
                    if (sampler != SamplerType::independent) options.sampler = sampler;
                    ch19::SampleDensities densities;
                    densities.judge = judge;
                    return render_film(
                        scene, options,
                        trace_with<ch19::trace>(ch19::prepare(scene), shares_of_white()),
                        ch19::allocation(densities));
                },
            .biased = judge == ch19::Judge::own,
            .features = features_of(19)};
}

[[maybe_unused]] static const bool added[] = {
    add_method(method("19", "19 adaptive", "#e000e0", SamplerType::independent)),
    add_method(method("19-own", "19, own judge (biased)", "#dbdb8d", SamplerType::independent,
                      ch19::Judge::own)),
    add_method(method("19-sobol", "19, Sobol", "#aa0099", SamplerType::sobol)),
};

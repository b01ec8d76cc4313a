#include "chapters/16_adaptive/estimator.h"
#include "tests/measure/methods.h"

static Method method(const char* name, const char* label, const char* color, SamplerType sampler,
                     ch16::Judge judge = ch16::Judge::other) {
    return {.name = name,
            .label = label,
            .color = color,
            .finds_light = "both ways",
            .scenes = {"high-contrast", "cornell-spheres", "cornell"},
            .render =
                [=](const Scene& scene, RenderOptions options) {
                    if (sampler != SamplerType::independent) options.sampler = sampler;
                    ch16::Shares shares;
                    shares.judge = judge;
                    return render_film(scene, options,
                                       trace_with<ch16::trace>(ch16::prepare(scene)),
                                       ch16::allocation(shares));
                },
            .biased = judge == ch16::Judge::own,
            .has_distribution = true};
}

[[maybe_unused]] static const bool added[] = {
    add_method(method("16", "16 adaptive", "#e000e0", SamplerType::independent)),
    add_method(method("16-own", "16, own judge (biased)", "#dbdb8d", SamplerType::independent,
                      ch16::Judge::own)),
    add_method(method("16-sobol", "16, Sobol", "#aa0099", SamplerType::sobol)),
};

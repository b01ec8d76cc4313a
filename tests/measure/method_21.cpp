#include "chapters/21_bidirectional/estimator.h"
#include "common/path/bidirectional.h"
#include "tests/measure/methods.h"

static SplatTrace fast(const Scene& scene) {
    return splat_trace_with<bidirectional::trace>(bidirectional::prepare(scene));
}
static SplatTrace plain(const Scene& scene) {
    return splat_trace_with<ch21::trace>(ch21::prepare(scene));
}
static Method method(const char* name, const char* label, const char* color,
                     SplatTrace (*trace)(const Scene&), SamplerType sampler) {
    return {.name = name,
            .label = label,
            .color = color,
            .finds_light = "from both ends",
            .scenes = {"cornell-spheres", "cornell", "lamp"},
            .render = [=](const Scene& scene, RenderOptions options) {
                options.search = LightSearch::both_ends;
                if (sampler != SamplerType::independent) options.sampler = sampler;
                return render_film(scene, options, trace(scene));
            }};
}

[[maybe_unused]] static const bool added[] = {
    add_method(method("21", "21 bidirectional", "#e377c2", fast, SamplerType::independent)),
    add_method(method("21-plain", "21, the lesson", "#8c2d72", plain, SamplerType::independent)),
    add_method(method("21-sobol", "21, Sobol", "#f7b6d2", fast, SamplerType::sobol)),
};

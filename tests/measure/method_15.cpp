#include "chapters/15_mis_ris/estimator.h"
#include "tests/measure/methods.h"

static Method with_candidates(const Scene& scene, int M) {
    return method_of<ch15::trace>(ch15::prepare(scene, M));
}

static NamedMethod method(const char* name, const char* label, const char* color, int M = 64) {
    return {.name = name,
            .label = label,
            .color = color,
            .finds_light = "both ways",
            .scenes = {"thousand-lights", "two-lights", "hidden-light", "veach-mis"},
            .render = by_trace([=](const Scene& scene) { return with_candidates(scene, M); })};
}

static NamedMethod with_sobol() {
    NamedMethod m = method("15-sobol", "15 MIS with RIS, Sobol", "#393b79");
    m.render = [render = m.render](const Scene& scene, RenderOptions options) {
        options.sampler = SamplerType::sobol;
        return render(scene, options);
    };
    return m;
}

[[maybe_unused]] static const bool added[] = {
    add_method(method("15", "15 MIS with RIS", "#d62728")),
    add_method(method("15-m16", "15 MIS with RIS, M = 16", "#7f0000", 16)),
    add_method(with_sobol()),
};

#include "chapters/15_mis_ris/estimator.h"
#include "tests/measure/methods.h"

static Trace with_candidates(const Scene& scene, int M) {
    return trace_with<ch15::trace>(ch15::prepare(scene, M));
}

static Method method(const char* name, const char* label, const char* color, int M = 64) {
    return {.name = name,
            .label = label,
            .color = color,
            .finds_light = "both ways",
            .scenes = {"thousand-lights", "two-lights", "hidden-light", "veach-mis"},
            .render = by_trace([=](const Scene& scene) { return with_candidates(scene, M); })};
}

static Method with_sobol() {
    Method m = method("15-sobol", "15 MIS with RIS, Sobol", "#393b79");
    m.render = [render = m.render](const Scene& scene, RenderOptions options) {
        options.sampler = SamplerType::sobol;
        return render(scene, options);
    };
    return m;
}

// Wrong on purpose, so that charts show what no number of samples cures.

static Trace clamped(const Scene& scene) {
    return [trace = with_candidates(scene, 64)](const Scene& s, Ray ray, Sampler& sampler,
                                                Recorder& recorder) {
        Rgb L = trace(s, ray, sampler, recorder);
        return max_component(L) > 1 ? L / max_component(L) : L;
    };
}

static Method clamp() {
    Method m = method("clamp", "15, samples clamped to 1", "#7b4173");
    m.render = by_trace(clamped);
    m.biased = true;
    return m;
}

static Method depth_cap() {
    Method m = method("depth-cap", "15, paths cut after 2", "#eebb88");
    m.render = [render = m.render](const Scene& scene, const RenderOptions& options) {
        Scene cut = scene;
        cut.max_depth = std::min(2, scene.max_depth);
        return render(cut, options);
    };
    m.biased = true;
    return m;
}

[[maybe_unused]] static const bool added[] = {
    add_method(method("15", "15 MIS with RIS", "#d62728")),
    add_method(method("15-m16", "15 MIS with RIS, M = 16", "#7f0000", 16)),
    add_method(with_sobol()),
    add_method(clamp()),
    add_method(depth_cap()),
};

#include "chapters/12_mis/estimator.h"
#include "tests/measure/methods.h"

using ch12::Heuristic, ch12::Strategy;

static Method method(const char* name, const char* label, const char* color,
                     ch12::Settings settings, Trace trace = ch12::trace) {
    return {.name = name,
            .label = label,
            .color = color,
            .finds_light = "both ways",
            .scenes = {"veach-mis", "cornell", "thousand-lights"},
            .prepare = ch12::prepare,
            .render = by_trace(trace, [=] { ch12::settings = settings; })};
}

/// Directions of the BSDF alone never meet a point light.
static Method bsdf_alone() {
    Method m = method("12-bsdf", "12 BSDF sampling alone", "#e377c2", {.strategy = Strategy::bsdf});
    m.refuse = {refuse_delta_lights};
    m.finds_light = "by chance";
    return m;
}

static Method with_sobol() {
    Method m = method("12-sobol", "12 MIS, Sobol", "#fb6a4a", {});
    m.render = [render = m.render](const Scene& scene, RenderOptions options) {
        options.sampler = SamplerType::sobol;
        return render(scene, options);
    };
    return m;
}

// Wrong on purpose, so that charts show what no number of samples cures.

static Rgb trace_clamped(const Scene& scene, Ray ray, Sampler& sampler, PathLog& log) {
    Rgb L = ch12::trace(scene, ray, sampler, log);
    return max_component(L) > 1 ? L / max_component(L) : L;
}

static Method clamp() {
    Method m = method("clamp", "12, samples clamped to 1", "#8c6d31", {}, trace_clamped);
    m.biased = true;
    return m;
}

static Method depth_cap() {
    Method m = method("depth-cap", "12, paths cut after 2", "#bcbd22", {});
    m.render = [render = m.render](const Scene& scene, const RenderOptions& options) {
        Scene cut = scene;
        cut.max_depth = std::min(2, scene.max_depth);
        return render(cut, options);
    };
    m.biased = true;
    return m;
}

[[maybe_unused]] static const bool added[] = {
    add_method(method("12", "12 MIS", "#d62728", {})),
    add_method(method("12-balance", "12 MIS, balance heuristic", "#f4a6a7",
                      {.heuristic = Heuristic::balance})),
    add_method(bsdf_alone()),
    add_method(
        method("12-light", "12 light sampling alone", "#9467bd", {.strategy = Strategy::light})),
    add_method(method("12-m16", "12 MIS, M = 16", "#7f0000", {.M = 16})),
    add_method(with_sobol()),
    add_method(clamp()),
    add_method(depth_cap()),
};

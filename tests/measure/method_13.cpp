#include "chapters/13_mis/estimator.h"
#include "tests/measure/methods.h"

using ch13::Strategy;

static Method method(const char* name, const char* label, const char* color,
                     ch13::Settings settings) {
    return {.name = name,
            .label = label,
            .color = color,
            .finds_light = "both ways",
            .scenes = {"veach-mis", "near-disk", "cornell"},
            .render = by_trace([=](const Scene& scene) {
                return trace_with<ch13::trace>(ch13::prepare(scene), settings);
            })};
}

static Method one_way(const char* name, const char* label, const char* color,
                      const char* finds_light, Strategy strategy) {
    Method m = method(name, label, color, {.strategy = strategy});
    m.finds_light = finds_light;
    if (strategy == Strategy::bsdf) m.refuse = {refuse_delta_lights};
    return m;
}

[[maybe_unused]] static const bool added[] = {
    add_method(method("13", "13 MIS", "#bcbd22", {})),
    add_method(method("13-balance", "13 MIS, balance heuristic", "#e7cb94",
                      {.heuristic = ch13::balance_heuristic})),
    add_method(method("13-one-sample", "13 MIS, one sample", "#8c6d31",
                      {.strategy = Strategy::one_sample})),
    add_method(one_way("13-bsdf", "13, BSDF alone", "#f7b6d2", "by chance", Strategy::bsdf)),
    add_method(one_way("13-light", "13, light alone", "#c5b0d5", "by aim", Strategy::light)),
};

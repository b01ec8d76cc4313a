#include "chapters/13_mis/estimator.h"
#include "tests/measure/methods.h"

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

[[maybe_unused]] static const bool added[] = {
    add_method(method("13", "13 MIS", "#bcbd22", {})),
    add_method(method("13-balance", "13 MIS, balance heuristic", "#e7cb94",
                      {.heuristic = ch13::balance_heuristic})),
    add_method(method("13-one-sample", "13 MIS, one sample", "#8c6d31", {.one_sample = true})),
};

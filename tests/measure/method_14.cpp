#include "chapters/14_mis/estimator.h"
#include "tests/measure/methods.h"

static NamedMethod method(const char* name, const char* label, const char* color,
                          float (*heuristic)(float, float)) {
    return {.name = name,
            .label = label,
            .color = color,
            .finds_light = "both ways",
            .scenes = {"veach-mis", "near-disk", "cornell"},
            .render = by_trace([=](const Scene& scene) {
                return method_of<ch14::trace>(ch14::prepare(scene, heuristic));
            })};
}

[[maybe_unused]] static const bool added[] = {
    add_method(method("14", "14 MIS", "#bcbd22", ch14::power_heuristic)),
    add_method(
        method("14-balance", "14 MIS, balance heuristic", "#e7cb94", ch14::balance_heuristic)),
};

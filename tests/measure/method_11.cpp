#include "chapters/11_light_importance/estimator.h"
#include "tests/measure/methods.h"

[[maybe_unused]] static const bool added =
    add_method({.name = "11",
                .label = "11 light importance",
                .color = "#2ca02c",
                .finds_light = "by light sampling",
                .scenes = {"thousand-lights", "two-lights", "far-and-near"},
                .refuse = {refuse_glossy},
                .render = by_trace([](const Scene& scene) {
                    return method_of<ch11::trace>(ch11::prepare(scene));
                })});

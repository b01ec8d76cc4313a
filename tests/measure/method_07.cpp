#include "chapters/07_path_tracing/estimator.h"
#include "tests/measure/methods.h"

[[maybe_unused]] static const bool added[] = {
    add_method({.name = "07",
                .label = "07 path tracing",
                .color = "#888888",
                .finds_light = "by chance",
                .scenes = {"cornell", "color-bleeding"},
                .refuse = {refuse_glossy, refuse_delta_lights},
                .render = by_trace([](const Scene&) { return method_of<ch07::trace>(); })}),
};

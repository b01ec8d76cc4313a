#include "chapters/06_path_tracing/estimator.h"
#include "tests/measure/methods.h"

[[maybe_unused]] static const bool added =
    add_method({.name = "06",
                .label = "06 path tracing",
                .color = "#888888",
                .scenes = {"cornell", "color-bleeding"},
                .refuse = {refuse_glossy, refuse_delta_lights},
                .render = by_trace(ch06::trace)});

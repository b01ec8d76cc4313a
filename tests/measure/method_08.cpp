#include "chapters/08_russian_roulette/estimator.h"
#include "tests/measure/methods.h"

[[maybe_unused]] static const bool added =
    add_method({.name = "08",
                .label = "08 Russian roulette",
                .color = "#8c564b",
                .finds_light = "by chance",
                .scenes = {"cornell", "closed-sphere"},
                .refuse = {refuse_glossy, refuse_delta_lights},
                .render = by_trace([](const Scene&) { return method_of<ch08::trace>(); })});

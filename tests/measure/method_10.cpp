#include "chapters/10_cosine_sampling/estimator.h"
#include "tests/measure/methods.h"

[[maybe_unused]] static const bool added =
    add_method({.name = "10",
                .label = "10 cosine sampling",
                .color = "#17becf",
                .finds_light = "by light sampling",
                .scenes = {"cornell", "horizon-sky"},
                .refuse = {refuse_glossy},
                .render = by_trace([](const Scene&) { return method_of<ch10::trace>(); })});

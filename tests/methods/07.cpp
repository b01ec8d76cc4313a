#include "chapters/07_path_tracing/estimator.h"
#include "tests/methods/table.h"

static const Rows added = {{.name = "07",
                            .label = "07 path tracing",
                            .color = "#888888",
                            .scenes = {"cornell", "color-bleeding"},
                            .search = LightSearch::random_hits,
                            .make = [](auto&, auto&) { return method_of<ch07::trace>(); }}};

#include "chapters/08_russian_roulette/estimator.h"
#include "tests/methods/table.h"

static const Rows added = {{.name = "08",
                            .label = "08 Russian roulette",
                            .color = "#8c564b",
                            .scenes = {"cornell", "closed-sphere"},
                            .search = LightSearch::random_hits,
                            .make = [](auto&, auto&) { return method_of<ch08::trace>(); }}};

#include "chapters/10_cosine_sampling/estimator.h"
#include "tests/methods/table.h"

static const Rows added = {{.name = "10",
                            .label = "10 cosine sampling",
                            .color = "#17becf",
                            .scenes = {"cornell", "horizon-sky"},
                            .make = [](auto&, auto&) { return method_of<ch10::trace>(); }}};

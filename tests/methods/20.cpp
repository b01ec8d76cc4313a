#include "chapters/20_light_tracing/estimator.h"
#include "tests/methods/table.h"

static const Rows added = {{.name = "20",
                            .label = "20 light tracing",
                            .color = "#224400",
                            .scenes = {"cornell", "two-lights"},
                            .search = LightSearch::from_lights,
                            .make = [](const Scene& scene, auto&) {
                                return method_of<ch20::trace_light>(ch20::endpoints_of(scene));
                            }}};

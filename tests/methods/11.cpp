#include "chapters/11_light_importance/estimator.h"
#include "tests/methods/table.h"

static const Rows added = {{.name = "11",
                            .label = "11 light importance",
                            .color = "#2ca02c",
                            .scenes = {"thousand-lights", "two-lights", "far-and-near"},
                            .make = [](const Scene& scene, auto&) {
                                return method_of<ch11::trace>(ch11::prepare(scene));
                            }}};

#include "chapters/21_bidirectional/estimator.h"
#include "tests/methods/table.h"

static const Rows added = {{.name = "21",
                            .label = "21 bidirectional",
                            .color = "#8c2d72",
                            .scenes = {"cornell-spheres", "cornell", "lamp"},
                            .search = LightSearch::both_ends,
                            .make = [](const Scene& scene, auto&) {
                                return method_of<ch21::trace>(endpoints_of(scene));
                            }}};

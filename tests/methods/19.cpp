#include "chapters/19_adaptive/estimator.h"
#include "tests/methods/table.h"

static Method adaptive(const Scene& scene, RenderOptions&) {
    Method method = method_of<ch19::trace>(ch19::prepare(scene), shares_of_white());
    method.allocation = ch19::allocation({});
    return method;
}
static const Rows added = {{.name = "19",
                            .label = "19 adaptive",
                            .color = "#e000e0",
                            .scenes = {"high-contrast", "cornell-spheres", "cornell"},
                            .make = adaptive}};

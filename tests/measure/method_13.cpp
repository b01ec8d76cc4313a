#include "chapters/13_glossy/estimator.h"
#include "tests/measure/methods.h"

using ch13::Strategy;

static NamedMethod method(const char* name, const char* label, const char* color,
                          const char* finds_light, Strategy strategy) {
    return {.name = name,
            .label = label,
            .color = color,
            .finds_light = finds_light,
            .scenes = {"veach-mis"},
            .render = by_trace([=](const Scene& scene) {
                return method_of<ch13::trace>(ch13::prepare(scene), strategy);
            })};
}

/// Directions of the BSDF alone never meet a point light.
static NamedMethod bsdf_alone() {
    NamedMethod m =
        method("13-bsdf", "13 glossy, by the BSDF alone", "#ff0077", "by chance", Strategy::bsdf);
    m.refuse = {refuse_delta_lights};
    return m;
}

[[maybe_unused]] static const bool added[] = {
    add_method(method("13", "13 glossy, by lights alone", "#9467bd", "by light sampling",
                      Strategy::light)),
    add_method(bsdf_alone()),
};

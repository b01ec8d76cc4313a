#include "chapters/19_adaptive/estimator.h"
#include "tests/measure/methods.h"

static Method method(const char* name, const char* label, const char* color) {
    return {.name = name,
            .label = label,
            .color = color,
            .finds_light = "both ways",
            .scenes = {"high-contrast", "cornell-spheres", "cornell"},
            .render =
                [](const Scene& scene, const RenderOptions& options) {
                    ch19::SampleDensities densities;
                    return render_film(
                        scene, options,
                        trace_with<ch19::trace>(ch19::prepare(scene), shares_of_white()),
                        ch19::allocation(densities));
                },
            .features = features_of(19)};
}

[[maybe_unused]] static const bool added[] = {
    add_method(method("19", "19 adaptive", "#e000e0")),
};

#include "chapters/19_adaptive/estimator.h"
#include "tests/measure/methods.h"

static NamedMethod method(const char* name, const char* label, const char* color) {
    return {.name = name,
            .label = label,
            .color = color,
            .finds_light = "both ways",
            .scenes = {"high-contrast", "cornell-spheres", "cornell"},
            .render =
                [](const Scene& scene, const RenderOptions& options) {
                    ch19::SampleDensities densities;
                    Method adaptive =
                        method_of<ch19::trace>(ch19::prepare(scene), shares_of_white());
                    adaptive.allocation = ch19::allocation(densities);
                    return render_film(scene, options, adaptive);
                },
            .features = features_of(19)};
}

[[maybe_unused]] static const bool added[] = {
    add_method(method("19", "19 adaptive", "#e000e0")),
};

#include "chapters/22_fast_bidirectional/estimator.h"
#include "tests/measure/methods.h"

static NamedMethod method(const char* name, const char* label, const char* color, int chances,
                          bool light_sampling) {
    return {.name = name,
            .label = label,
            .color = color,
            .finds_light = "from both ends",
            .scenes = {"cornell-spheres", "cornell", "lamp"},
            .render =
                [=](const Scene& scene, const RenderOptions& options) {
                    return render_film(
                        scene, options,
                        method_of<ch22::trace>(ch22::prepare(scene, chances, light_sampling)));
                },
            .search = LightSearch::both_ends};
}

[[maybe_unused]] static const bool added[] = {
    add_method(method("22", "22 fast bidirectional", "#e377c2", 16, true)),
    add_method(method("22-weights", "22, weights alone", "#c49c94", 0, false)),
    add_method(method("22-direct", "22, no chances", "#c7c7c7", 0, true)),
};

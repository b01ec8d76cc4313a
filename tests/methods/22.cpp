#include "chapters/22_fast_bidirectional/estimator.h"
#include "tests/methods/table.h"

static NamedMethod row(const char* name, const char* label, const char* color, int samples,
                       bool light_sampling) {
    return {.name = name,
            .label = label,
            .color = color,
            .scenes = {"cornell-spheres", "cornell", "lamp"},
            .search = LightSearch::both_ends,
            .make = [=](const Scene& scene, auto&) {
                return method_of<ch22::trace>(ch22::prepare(scene, samples, light_sampling));
            }};
}
static const Rows added = {row("22", "22 fast bidirectional", "#e377c2", 16, true),
                           row("22-weights", "22, weights alone", "#c49c94", 0, false),
                           row("22-direct", "22, direct light", "#c7c7c7", 0, true)};

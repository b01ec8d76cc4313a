#include "chapters/14_mis/estimator.h"
#include "tests/methods/table.h"

static NamedMethod row(const char* name, const char* label, const char* color,
                       float (*heuristic)(float, float)) {
    return {.name = name,
            .label = label,
            .color = color,
            .scenes = {"veach-mis", "near-disk", "cornell"},
            .make = [=](const Scene& scene, auto&) {
                return method_of<ch14::trace>(ch14::prepare(scene, heuristic));
            }};
}
static const Rows added = {
    row("14", "14 MIS", "#bcbd22", ch14::power_heuristic),
    row("14-balance", "14 MIS, balance heuristic", "#e7cb94", ch14::balance_heuristic)};

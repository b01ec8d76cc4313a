#include "chapters/12_ris/estimator.h"
#include "tests/methods/table.h"

static NamedMethod row(const char* name, const char* label, const char* color, int M) {
    return {.name = name,
            .label = label,
            .color = color,
            .scenes = {"thousand-lights", "hidden-light"},
            .make = [=](const Scene& scene, auto&) {
                return method_of<ch12::trace>(ch12::prepare(scene, M));
            }};
}
static const Rows added = {row("12", "12 RIS, M = 16", "#ff7f0e", 16),
                           row("12-m2", "12 RIS, M = 2", "#fdae6b", 2),
                           row("12-m32", "12 RIS, M = 32", "#a63603", 32)};

#include "chapters/12_ris/estimator.h"
#include "tests/measure/methods.h"

static bool add(const char* name, const char* label, const char* color, int M) {
    return add_method({.name = name,
                       .label = label,
                       .color = color,
                       .finds_light = "by light sampling",
                       .scenes = {"thousand-lights", "hidden-light"},
                       .refuse = {refuse_glossy},
                       .render = by_trace([=](const Scene& scene) {
                           return method_of<ch12::trace>(ch12::prepare(scene, M));
                       })});
}
[[maybe_unused]] static const bool added[] = {
    add("12", "12 RIS, M = 16", "#ff7f0e", 16),
    add("12-m2", "12 RIS, M = 2", "#fdae6b", 2),
    add("12-m32", "12 RIS, M = 32", "#a63603", 32),
};

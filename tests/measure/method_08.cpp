#include "chapters/08_light_sampling/estimator.h"
#include "tests/measure/methods.h"

using ch08::LightMeasure;

static bool add(const char* name, const char* label, const char* color, LightMeasure measure) {
    return add_method(
        {.name = name,
         .label = label,
         .color = color,
         .finds_light = "by aim",
         .scenes = {"cornell", "near-light", "near-disk"},
         .refuse = {refuse_glossy},
         .render = by_trace([=](const Scene&) { return trace_with<ch08::trace>(measure); })});
}
[[maybe_unused]] static const bool added[] = {
    add("08", "08 light sampling", "#1f77b4", LightMeasure::solid_angle),
    add("08-area", "08 lights by area", "#9ecae1", LightMeasure::area),
};

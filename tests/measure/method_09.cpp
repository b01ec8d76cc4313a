#include "chapters/09_light_sampling/estimator.h"
#include "tests/measure/methods.h"

using ch09::LightMeasure;

static bool add(const char* name, const char* label, const char* color, LightMeasure measure) {
    return add_method(
        {.name = name,
         .label = label,
         .color = color,
         .finds_light = "by light sampling",
         .scenes = {"cornell", "near-light", "near-disk"},
         .refuse = {refuse_glossy},
         .render = by_trace([=](const Scene&) { return method_of<ch09::trace>(measure); })});
}
[[maybe_unused]] static const bool added[] = {
    add("09", "09 light sampling", "#1f77b4", LightMeasure::solid_angle),
    add("09-area", "09 lights by area", "#9ecae1", LightMeasure::area),
};

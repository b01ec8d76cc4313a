#include "chapters/09_light_sampling/estimator.h"
#include "tests/methods/table.h"

using ch09::LightMeasure;

static NamedMethod row(const char* name, const char* label, const char* color,
                       LightMeasure measure) {
    return {.name = name,
            .label = label,
            .color = color,
            .scenes = {"cornell", "near-light", "near-disk"},
            .make = [=](auto&, auto&) { return method_of<ch09::trace>(measure); }};
}
static const Rows added = {row("09", "09 light sampling", "#1f77b4", LightMeasure::solid_angle),
                           row("09-area", "09 lights by area", "#9ecae1", LightMeasure::area)};

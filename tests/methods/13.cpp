#include "chapters/13_glossy/estimator.h"
#include "tests/methods/table.h"

using ch13::Strategy;

static NamedMethod row(const char* name, const char* label, const char* color, LightSearch search,
                       Strategy strategy) {
    return {.name = name,
            .label = label,
            .color = color,
            .scenes = {"veach-mis"},
            .search = search,
            .make = [=](const Scene& scene, auto&) {
                return method_of<ch13::trace>(ch13::prepare(scene), strategy);
            }};
}
static const Rows added = {row("13", "13 glossy, by lights alone", "#9467bd",
                               LightSearch::light_sampling, Strategy::light),
                           row("13-bsdf", "13 glossy, by the BSDF alone", "#ff0077",
                               LightSearch::random_hits, Strategy::bsdf)};

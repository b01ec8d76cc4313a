#include "chapters/12_mis/estimator.h"
#include "tests/measure/methods.h"

using ch12::Heuristic, ch12::Strategy;

static void refuse_nothing(const Scene&) {}

static bool add(const char* name, const char* label, const char* color, ch12::Settings settings,
                void (*refuse)(const Scene&) = refuse_nothing) {
    return add_method({.name = name,
                       .label = label,
                       .color = color,
                       .scenes = {"veach-mis", "cornell", "thousand-lights"},
                       .refuse = {refuse},
                       .prepare = ch12::prepare,
                       .render = by_trace(ch12::trace, [=] { ch12::settings = settings; })});
}
[[maybe_unused]] static const bool added[] = {
    add("12", "12 MIS", "#d62728", {}),
    add("12-balance", "12 MIS, balance heuristic", "#f4a6a7",
        {Strategy::mis, Heuristic::balance, 1}),
    add("12-bsdf", "12 BSDF sampling alone", "#e377c2", {Strategy::bsdf, Heuristic::power, 1},
        refuse_delta_lights),
    add("12-light", "12 light sampling alone", "#9467bd", {Strategy::light, Heuristic::power, 1}),
    add("12-m8", "12 MIS in RIS, M = 8", "#7f0000", {Strategy::mis, Heuristic::power, 8}),
};

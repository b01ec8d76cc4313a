// The rows of the chapters, compiled for one chapter at a time, by -DCHAPTER_NN: what chapter NN
// teaches is in common/ later under the same name, and overloads of both would be ambiguous.
#include "tests/methods/table.h"

#ifdef CHAPTER_07
#include "chapters/07_path_tracing/estimator.h"

static const Rows added = {{.name = "07",
                            .label = "07 path tracing",
                            .color = "#888888",
                            .scenes = {"cornell", "color-bleeding"},
                            .search = LightSearch::random_hits,
                            .make = [](auto&, auto&) { return method_of<ch07::trace>(); }}};
#elif defined CHAPTER_08
#include "chapters/08_russian_roulette/estimator.h"

static const Rows added = {{.name = "08",
                            .label = "08 Russian roulette",
                            .color = "#8c564b",
                            .scenes = {"cornell", "closed-sphere"},
                            .search = LightSearch::random_hits,
                            .make = [](auto&, auto&) { return method_of<ch08::trace>(); }}};
#elif defined CHAPTER_09
#include "chapters/09_light_sampling/estimator.h"

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
#elif defined CHAPTER_10
#include "chapters/10_cosine_sampling/estimator.h"

static const Rows added = {{.name = "10",
                            .label = "10 cosine sampling",
                            .color = "#17becf",
                            .scenes = {"cornell", "horizon-sky"},
                            .make = [](auto&, auto&) { return method_of<ch10::trace>(); }}};
#elif defined CHAPTER_11
#include "chapters/11_light_importance/estimator.h"

static const Rows added = {{.name = "11",
                            .label = "11 light importance",
                            .color = "#2ca02c",
                            .scenes = {"thousand-lights", "two-lights", "far-and-near"},
                            .make = [](const Scene& scene, auto&) {
                                return method_of<ch11::trace>(ch11::prepare(scene));
                            }}};
#elif defined CHAPTER_12
#include "chapters/12_ris/estimator.h"

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
#elif defined CHAPTER_13
#include "chapters/13_glossy/estimator.h"

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
#elif defined CHAPTER_14
#include "chapters/14_mis/estimator.h"

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
#elif defined CHAPTER_15
#include "chapters/15_mis_ris/estimator.h"

static NamedMethod row(const char* name, const char* label, const char* color, int M = 64,
                       SamplerType sampler = SamplerType::independent) {
    return {.name = name,
            .label = label,
            .color = color,
            .scenes = {"thousand-lights", "two-lights", "hidden-light", "veach-mis"},
            .make = [=](const Scene& scene, RenderOptions& options) {
                if (sampler != SamplerType::independent) options.sampler = sampler;
                return method_of<ch15::trace>(ch15::prepare(scene, M));
            }};
}
static const Rows added = {
    row("15", "15 MIS with RIS", "#d62728"),
    row("15-m16", "15 MIS with RIS, M = 16", "#7f0000", 16),
    row("15-sobol", "15 MIS with RIS, Sobol", "#393b79", 64, SamplerType::sobol)};
#elif defined CHAPTER_16
#include "chapters/16_lens_and_shutter/estimator.h"

static NamedMethod row(const char* name, const char* label, const char* color,
                       SamplerType sampler = SamplerType::independent) {
    return {.name = name,
            .label = label,
            .color = color,
            .scenes = {"bokeh", "moving-ball"},
            .make = [=](const Scene& scene, RenderOptions& options) {
                if (sampler != SamplerType::independent) options.sampler = sampler;
                return method_of<ch16::trace>(ch16::prepare(scene));
            }};
}
static const Rows added = {row("16", "16 lens and shutter", "#0000ff"),
                           row("16-sobol", "16, Sobol", "#9edae5", SamplerType::sobol)};
#elif defined CHAPTER_17
#include "chapters/17_sky_image/estimator.h"

static NamedMethod row(const char* name, const char* label, const char* color,
                       SamplerType sampler = SamplerType::independent, bool compensate = true) {
    return {.name = name,
            .label = label,
            .color = color,
            .scenes = {"sky"},
            .make = [=](const Scene& scene, RenderOptions& options) {
                if (sampler != SamplerType::independent) options.sampler = sampler;
                return method_of<ch17::trace>(ch17::prepare(scene, 64, compensate));
            }};
}
static const Rows added = {
    row("17", "17 image of the sky", "#2b8cbe"),
    row("17-plain", "17, no compensation", "#a6bddb", SamplerType::independent, false),
    row("17-sobol", "17, Sobol", "#a8ddb5", SamplerType::sobol)};
#elif defined CHAPTER_18
#include "chapters/18_dispersion/estimator.h"

static NamedMethod row(const char* name, const char* label, const char* color,
                       SamplerType sampler = SamplerType::independent) {
    return {.name = name,
            .label = label,
            .color = color,
            .scenes = {"prism"},
            .make = [=](const Scene& scene, RenderOptions& options) {
                if (sampler != SamplerType::independent) options.sampler = sampler;
                return method_of<ch18::trace>(ch18::prepare(scene), shares_of_white());
            }};
}
static const Rows added = {row("18", "18 dispersion", "#54278f"),
                           row("18-sobol", "18, Sobol", "#bcbddc", SamplerType::sobol)};
#elif defined CHAPTER_19
#include "chapters/19_adaptive/estimator.h"

static Method adaptive(const Scene& scene, RenderOptions&) {
    Method method = method_of<ch19::trace>(ch19::prepare(scene), shares_of_white());
    method.allocation = ch19::allocation({});
    return method;
}
static const Rows added = {{.name = "19",
                            .label = "19 adaptive",
                            .color = "#e000e0",
                            .scenes = {"high-contrast", "cornell-spheres", "cornell"},
                            .make = adaptive}};
#elif defined CHAPTER_20
#include "chapters/20_light_tracing/estimator.h"

static const Rows added = {{.name = "20",
                            .label = "20 light tracing",
                            .color = "#224400",
                            .scenes = {"cornell", "two-lights"},
                            .search = LightSearch::from_lights,
                            .make = [](const Scene& scene, auto&) {
                                return method_of<ch20::trace_light>(ch20::endpoints_of(scene));
                            }}};
#elif defined CHAPTER_21
#include "chapters/21_bidirectional/estimator.h"

static const Rows added = {{.name = "21",
                            .label = "21 bidirectional",
                            .color = "#8c2d72",
                            .scenes = {"cornell-spheres", "cornell", "lamp"},
                            .search = LightSearch::both_ends,
                            .make = [](const Scene& scene, auto&) {
                                return method_of<ch21::trace>(endpoints_of(scene));
                            }}};
#elif defined CHAPTER_22
#include "chapters/22_fast_bidirectional/estimator.h"

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
#elif defined CHAPTER_23
#include "chapters/23_photon_mapping/estimator.h"

static NamedMethod row(const char* name, const char* label, const char* color,
                       ch23::PhotonSettings settings) {
    return {.name = name,
            .label = label,
            .color = color,
            .scenes = {"pool", "sds", "cornell-spheres"},
            .search = LightSearch::photons,
            .make = [=](const Scene& scene, RenderOptions& options) mutable {
                settings.sampler = options.sampler, settings.seed = options.seed;
                return ch23::photon_passes(scene, settings);
            }};
}
static const Rows added = {
    row("23", "23 photon mapping", "#00c896", {}),
    row("23-few", "23 with few photons", "#66dfc0", {.light_paths = 200, .radius = 0.01f})};
#elif defined CHAPTER_24
#include "chapters/24_progressive_photons/estimator.h"

static NamedMethod row(const char* name, const char* label, const char* color,
                       PhotonSettings settings) {
    return {.name = name,
            .label = label,
            .color = color,
            .scenes = {"pool", "sds", "cornell-spheres"},
            .search = LightSearch::photons,
            .make = [=](const Scene& scene, RenderOptions& options) mutable {
                settings.sampler = options.sampler, settings.seed = options.seed;
                return ch24::photon_passes(scene, settings);
            }};
}
static const Rows added = {
    row("24", "24 progressive photons", "#8fae00", {}),
    row("24-few", "24 with few photons", "#c8df66", {.light_paths = 200, .radius = 0.015f})};
#elif defined CHAPTER_25
#include "chapters/25_vertex_merging/estimator.h"

static NamedMethod row(const char* name, const char* label, const char* color,
                       PhotonSettings settings) {
    return {.name = name,
            .label = label,
            .color = color,
            .scenes = {"sds", "caustic", "cornell-spheres"},
            .search = LightSearch::merging,
            .make = [=](const Scene& scene, RenderOptions& options) mutable {
                if (settings.sampler != SamplerType::independent)
                    options.sampler = settings.sampler;
                settings.sampler = options.sampler, settings.seed = options.seed;
                return ch25::merging_passes(scene, settings);
            }};
}
static const Rows added = {
    row("25", "25 vertex merging", "#b8860b", {.light_paths = 0}),
    row("25-few", "25 with few photons", "#e0c878", {.light_paths = 200, .radius = 0.02f}),
    row("25-sobol", "25, Sobol", "#e7ba52", {.sampler = SamplerType::sobol, .light_paths = 0})};
#endif

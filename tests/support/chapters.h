// All chapters that find light, each by each of its ways: for what must hold in every one of them.
#pragma once
#include "common/path/trace.h"
#include "tests/support/estimators.h"
// In this order: names of a lower chapter must not be found by way of a higher one.
#include "chapters/06_path_tracing/estimator.h"
#include "chapters/07_russian_roulette/estimator.h"
#include "chapters/08_light_sampling/estimator.h"
#include "chapters/09_cosine_sampling/estimator.h"
#include "chapters/10_light_importance/estimator.h"
#include "chapters/11_ris/estimator.h"
#include "chapters/12_glossy/estimator.h"
#include "chapters/13_mis/estimator.h"
#include "chapters/14_mis_ris/estimator.h"

struct Chapter {
    std::string name;
    Trace trace;
    bool by_chance = false;  // meets lights as paths go: more noise, and no lights without size
};

/// 12 to 14, which know rough metal.
inline std::vector<Chapter> glossy_chapters(const Scene& scene) {
    LightTable lights = ch12::prepare(scene);
    ch13::Settings one_sample{ch13::power_heuristic, true};
    return {{"12 by the BSDF", trace_with<ch12::trace>(lights, ch12::Strategy::bsdf), true},
            {"12 by lights", trace_with<ch12::trace>(lights, ch12::Strategy::light)},
            {"13", trace_with<ch13::trace>(lights, ch13::Settings())},
            {"13, one sample", trace_with<ch13::trace>(lights, one_sample), true},
            {"14", trace_with<ch14::trace>(ch14::prepare(scene))}};
}
/// 06 to 14.
inline std::vector<Chapter> every_chapter(const Scene& scene) {
    using ch08::LightMeasure;
    std::vector<Chapter> chapters = {{"06", trace_with<ch06::trace>(), true},
                                     {"07", trace_with<ch07::trace>(), true},
                                     {"08 by area", trace_with<ch08::trace>(LightMeasure::area)},
                                     {"08", trace_with<ch08::trace>(LightMeasure::solid_angle)},
                                     {"09", trace_with<ch09::trace>()},
                                     {"10", trace_with<ch10::trace>(ch10::prepare(scene))},
                                     {"11", trace_with<ch11::trace>(ch11::prepare(scene), 4)}};
    for (Chapter& chapter : glossy_chapters(scene)) chapters.push_back(std::move(chapter));
    return chapters;
}

// All chapters that find light, each by each of its ways: for what must hold in every one of them.
#pragma once
#include "common/path/method.h"
#include "tests/support/estimators.h"
// In this order: names of a lower chapter must not be found through a higher one.
#include "tests/traces/07.h"
#include "tests/traces/08.h"
#include "tests/traces/09.h"
#include "tests/traces/10.h"
#include "tests/traces/11.h"
#include "tests/traces/12.h"
#include "tests/traces/13.h"
#include "tests/traces/14.h"
#include "tests/traces/15.h"

struct Chapter {
    std::string name;
    Method trace;
    bool by_chance = false;  // meets lights as paths go: more noise, and no lights without size
};

/// 13 to 15, which know rough metal.
inline std::vector<Chapter> glossy_chapters(const Scene& scene) {
    LightTable lights = ch13::prepare(scene);
    return {{"13 by the BSDF", method_of<ch13::trace>(lights, ch13::Strategy::bsdf), true},
            {"13 by lights", method_of<ch13::trace>(lights, ch13::Strategy::light)},
            {"14", method_of<ch14::trace>(ch14::prepare(scene))},
            {"15", method_of<ch15::trace>(ch15::prepare(scene))}};
}
/// 07 to 15.
inline std::vector<Chapter> every_chapter(const Scene& scene) {
    using ch09::LightMeasure;
    std::vector<Chapter> chapters = {{"07", method_of<ch07::trace>(), true},
                                     {"08", method_of<ch08::trace>(), true},
                                     {"09 by area", method_of<ch09::trace>(LightMeasure::area)},
                                     {"09", method_of<ch09::trace>(LightMeasure::solid_angle)},
                                     {"10", method_of<ch10::trace>()},
                                     {"11", method_of<ch11::trace>(ch11::prepare(scene))},
                                     {"12", method_of<ch12::trace>(ch12::prepare(scene, 4))}};
    for (Chapter& chapter : glossy_chapters(scene)) chapters.push_back(std::move(chapter));
    return chapters;
}

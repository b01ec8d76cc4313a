// A chapter's passes for tests: a template, so that one file can compile it for all of them.
#pragma once
#include <type_traits>

#include "common/scene/scene.h"

template <auto passes, class Settings>
std::invoke_result_t<decltype(passes), const Scene&, const Settings&> passes_of(
    const Scene& scene, const Settings& settings) {
    return passes(scene, settings);
}

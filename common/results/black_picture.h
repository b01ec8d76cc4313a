// The possible causes of a black picture, in words.
#pragma once
#include <string>
#include <vector>

#include "common/options/options.h"
#include "common/scene/scene.h"

/// The causes that may make a picture of this scene black, one line each: those that a few hundred
/// rays do not rule out. Not empty.
///
/// chance   the probability that a path hits a light at random; see LightSearch::by_chance
/// tested by  "failure: a black picture names what makes it black"
std::vector<std::string> causes_of_black(const Scene& scene, const RenderOptions& options,
                                         double chance);

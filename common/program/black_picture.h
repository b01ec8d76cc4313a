// Why a picture may be black, in words.
#pragma once
#include <string>
#include <vector>

#include "common/program/options.h"
#include "common/scene/scene.h"

/// What can make a picture of this scene black, a line for each cause that a few hundred rays do
/// not rule out. Not empty.
///
/// chance   of a path to meet a light where nothing aims at it; see LightSearch::by_chance
/// tested by  "failure: a black picture names what makes it black"
std::vector<std::string> causes_of_black(const Scene& scene, const RenderOptions& options,
                                         double chance);

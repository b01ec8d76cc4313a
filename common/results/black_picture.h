// The possible causes of a black picture, in words.
#pragma once
#include <string>
#include <vector>

#include "common/options/options.h"
#include "common/scene/scene.h"

/// The causes that may make a picture of this scene black, one line each, as far as the surfaces in
/// view and the lights tell them; nothing is rendered. Not empty.
/// tested by  "truth: the causes of a black picture, all of them, and no others"
std::vector<std::string> causes_of_black(const Scene& scene, const RenderOptions& options);

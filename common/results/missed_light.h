// Light that a chapter leaves out of a picture, or that too few of its paths find.
#pragma once
#include <string>
#include <vector>

#include "common/options/options.h"
#include "common/scene/scene.h"

/// One line for each kind of light that this chapter's search for light misses in the scene, or
/// finds too rarely for its reported error to be true. They follow from sizes and distances of
/// lights and materials, what rays through the pixels meet, and the number of samples.
/// tested by  "truth: what each search for light leaves out, scene by scene"
std::vector<std::string> missed_light(const Scene& scene, const RenderOptions& options,
                                      const Film& film);

// Warnings about pictures whose estimated error may be wrong.
#pragma once
#include <string>
#include <vector>

#include "common/render/render.h"

/// One line for each reason why the error of the picture may exceed its standard error: most light
/// comes from a few samples, the error is unknown, or this method misses light or rarely finds it.
/// Empty if there is none.
/// tested by  "truth: what a film says of its own error"
/// tested by  "truth: what each search for light leaves out, scene by scene"
std::vector<std::string> warnings_of(const Scene& scene, const RenderOptions& options,
                                     const Rendering& rendering);

/// Only the warnings that follow from the samples. place: where the largest of them is, in words.
std::vector<std::string> warnings_of(const Film& film, const SampleCounts& counts,
                                     const std::string& place = "");

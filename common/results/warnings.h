// Warnings about pictures whose estimated error may be wrong.
#pragma once
#include <string>
#include <vector>

#include "common/rendering/render_film.h"

/// One line for each reason why the error of the picture may exceed its standard error: most light
/// comes from a few samples, the error is unknown, or this method misses light or rarely finds it.
/// Empty if there is none.
/// tested by  "truth: what a film says of its own error"
std::vector<std::string> warnings_of(const Scene& scene, const RenderOptions& options,
                                     const Rendering& rendering);

/// Only the warnings that follow from the samples.
std::vector<std::string> warnings_of(const Film& film, const SampleCounts& counts);

// What a picture's own numbers cannot be trusted to tell, in words.
#pragma once
#include <string>
#include <vector>

#include "common/program/render.h"

/// One line for each reason why the picture may be further off than its standard error says: few
/// samples that carry it, an error that is not known, light that this way of rendering misses or
/// meets by rare chance. Empty when there is none.
/// tested by  "failure: where intervals do not cover the truth, a warning says so"
std::vector<std::string> warnings_of(const Scene& scene, const RenderOptions& options,
                                     const Rendering& rendering);

/// Of those, what the samples alone tell.
std::vector<std::string> warnings_of(const Film& film, const SampleCounts& counts);

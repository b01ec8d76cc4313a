// --explain: one path in words, as a table and as a drawing.
#pragma once
#include "common/path/trace.h"
#include "common/program/render.h"

/// Prints the path that makes sample options.explain_sample of one pixel and what it adds up to,
/// and draws it as an SVG beside the first picture. Returns the exit code. `halves`: a pixel's
/// samples belong to two halves by turns; see Allocation.
int explain(const Scene& scene, const RenderOptions& options, const SplatTrace& trace, bool halves);

/// Options that explain the sample of a render that brings most, to all pixels together: the one
/// that makes the worst firefly. Says which it is; throws InputError when all are black.
RenderOptions explain_brightest(const RenderOptions& options, const Rendering& rendering);

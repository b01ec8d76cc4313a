// --explain: one path in words and as a drawing.
#pragma once
#include "common/path/trace.h"
#include "common/program/options.h"

/// Prints the path that makes sample options.explain_sample of one pixel, and draws it as an SVG
/// beside the first picture. Returns the exit code. `halves`: a pixel's samples belong to two
/// halves by turns; see Allocation.
int explain(const Scene& scene, const RenderOptions& options, const SplatTrace& trace, bool halves);

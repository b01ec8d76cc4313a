// --explain: describes one path step by step, with a table and a drawing.
#pragma once
#include "common/path/method.h"
#include "common/render/render_film.h"

/// Prints the path of sample options.explain_sample of one pixel and the sum of its contributions,
/// and draws it as an SVG beside the first picture. Returns the exit code.
int explain(const Scene& scene, const RenderOptions& options, const Method& method);

/// Options that explain the largest sample of a render, summed over all its pixels: the worst
/// firefly. Prints which one it is; throws InputError if all samples are black.
RenderOptions explain_brightest(const RenderOptions& options, const Rendering& rendering);

// What the program of a chapter does: renders, or explains one path, and writes the results.
#pragma once
#include "common/render/loading.h"
#include "common/render/render_film.h"

/// What a chapter's program does with its scene: renders it or explains one path, and writes what
/// the options ask for. Returns the exit code.
int render(const Scene& scene, const RenderOptions& options, const Method& method);

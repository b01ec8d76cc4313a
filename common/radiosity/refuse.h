// What radiosity cannot render.
#pragma once
#include "common/scene/scene.h"

/// Throws InputError for all that has no radiosity: paths are LD*E, and lamps have a surface.
/// tested by  "input: what has no radiosity is refused, with its place in the file"
void refuse(const Scene& scene);

// What radiosity cannot render.
#pragma once
#include "common/radiosity/patches.h"

/// Throws InputError for all that has no radiosity: paths are LD*E, and lamps have a surface.
/// tested by  "input: what has no radiosity is refused, with its place in the file"
void refuse(const Scene& scene);

/// Throws InputError for a closed room that absorbs nothing: its light grows for ever.
/// tested by  "input: a closed room that reflects all light is refused, an open one is not"
void refuse_no_loss(const Scene& scene, const Patches& patches);

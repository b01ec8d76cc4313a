// Finds the pixels that show the edge of a lamp.
#pragma once
#include "common/picture/film.h"
#include "common/scene/scene.h"

/// Marks the film's pixels whose centre emits different light than that of a neighbour. Their error
/// is large, and stratified samples reduce it much more than that of other pixels.
void mark_lamp_edges(const Scene& scene, int threads, Film& film);

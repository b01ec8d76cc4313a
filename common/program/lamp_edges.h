// Which pixels show the edge of something that shines.
#pragma once
#include "common/picture/film.h"
#include "common/scene/scene.h"

/// Marks the film's pixels whose middle shines unlike that of a neighbour: their error is large,
/// and samples that are evenly spread make far less of it than others.
void mark_lamp_edges(const Scene& scene, int threads, Film& film);

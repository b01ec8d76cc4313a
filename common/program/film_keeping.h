// The film of a render on disk: written now and then, and gone on from.
#pragma once
#include "common/picture/film_file.h"
#include "common/program/render.h"

/// The samples that the options ask for: all of a pixel, or their part of them. With --time and no
/// --spp the last one is out of reach. Throws UsageError when there are more parts than samples.
SampleRange wanted_samples(const Scene& scene, const RenderOptions& options);

/// Goes on from the film that the options name, when there is one. Throws InputError when it is of
/// other options, or of other samples than those that are wanted.
void continue_film(const Scene& scene, const RenderOptions& options, Rendering& rendering);

/// What a film is of that has all samples; and one that has these.
FilmLabel label_of(const Scene& scene, const RenderOptions& options);
FilmLabel label_of(const Scene& scene, const RenderOptions& options, const Rendering& rendering);

/// Writes the film that the options name, if any. Throws InputError.
void save_film(const Scene& scene, const RenderOptions& options, const Rendering& rendering);

// The film of a render on disk: saved at intervals, and continued later.
#pragma once
#include "common/picture/film_file.h"
#include "common/render/render_film.h"

/// The samples of a pixel that the options ask for: all, or those of a part. Their number is not
/// limited with --time but without --spp. Throws UsageError if there are more parts than samples.
SampleRange wanted_samples(const Scene& scene, const RenderOptions& options);

/// Continues from the film that the options name, or makes one without samples; it is this
/// program's alone then. Throws InputError if another program writes it, its options differ, or it
/// has other samples than the wanted ones.
void continue_film(const Scene& scene, const RenderOptions& options, Rendering& rendering);

/// The label of a film with all samples; and (below) with the given ones.
FilmLabel label_of(const Scene& scene, const RenderOptions& options);
FilmLabel label_of(const Scene& scene, const RenderOptions& options, const Rendering& rendering);

/// Writes the film that the options name, if any. Throws InputError.
void save_film(const Scene& scene, const RenderOptions& options, const Rendering& rendering);
/// The same; tells what is wrong, and the render goes on.
void try_to_save_film(const Scene& scene, const RenderOptions& options, const Rendering& rendering);

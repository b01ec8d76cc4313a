// From a file named on the command line to a scene that is ready to trace.
#pragma once
#include "common/program/options.h"
#include "common/scene/scene.h"

/// Reads the scene that the options name, makes it ready to trace, and puts the options' size,
/// samples and depth in place of the scene's own.
///
/// Throws for what refuse_distribution() names, unless the chapter `has_distribution`.
Scene load(const RenderOptions& options, bool has_distribution = false);

/// Throws InputError when the scene has a point or distant light: a path that only looks for light
/// by chance never finds one.
void refuse_delta_lights(const Scene& scene);

/// Throws InputError when a surface of the scene is a rough conductor, which chapters before 13
/// have not got.
void refuse_glossy(const Scene& scene);

/// Throws InputError when the scene has what chapter 16 is about: a lens, shapes that move, glass
/// that disperses, or a picture for the sky.
void refuse_distribution(const Scene& scene);

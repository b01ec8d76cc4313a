// From a file named on the command line to a scene that is ready to trace.
#pragma once
#include "common/program/options.h"
#include "common/scene/scene.h"

/// What chapters 16, 17 and 18 add, each to all before it.
enum class Features { none, lens_and_shutter, sky_image, dispersion };

/// Reads the scene that the options name, makes it ready to trace, and puts the options' size,
/// samples and depth in place of the scene's own.
///
/// Throws for what refuse_features() names.
Scene load(const RenderOptions& options, Features features = Features::none);

/// Throws InputError when the scene has a point or distant light: a path that only looks for light
/// by chance never finds one.
void refuse_delta_lights(const Scene& scene);

/// Throws InputError when a surface of the scene is a rough conductor, which chapters before 13
/// have not got.
void refuse_glossy(const Scene& scene);

/// Throws InputError when the scene has a lens, shapes that move, an image for the sky or glass
/// that disperses, and the chapter, which has these features, cannot render it.
void refuse_features(const Scene& scene, Features features);

// From a file named on the command line to a scene that is ready to trace.
#pragma once
#include "common/program/options.h"
#include "common/scene/scene.h"

/// The scene features that chapters 16, 17 and 18 add; each includes those before it.
enum class Features { none, lens_and_shutter, sky_image, dispersion };

/// Reads and prepares the scene that the options name. Size, samples and depth in the options
/// replace those of the scene.
///
/// Throws for what refuse_features() names.
Scene load(const RenderOptions& options, Features features = Features::none);

/// Throws InputError if the scene has a point or distant light: a path that finds light only by
/// random hits never finds it.
void refuse_delta_lights(const Scene& scene);

/// Throws InputError if a surface of the scene is a rough conductor, which chapters before 13 do
/// not support.
void refuse_glossy(const Scene& scene);

/// Throws InputError if the scene has a lens, moving shapes, a sky image or dispersive glass, and
/// the chapter's `features` do not support it.
void refuse_features(const Scene& scene, Features features);

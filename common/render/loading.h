// From a file named on the command line to a scene that is ready to trace.
#pragma once
#include "common/render/options.h"
#include "common/scene/scene.h"

/// Those features of scenes that not all chapters render.
struct Features {
    bool lens = false, shutter = false, sky_image = false, dispersion = false, rough = false;
};
constexpr Features features_of(int chapter) {
    auto within = [&](int first, int last) { return first <= chapter && chapter <= last; };
    return {.lens = within(16, 19) || within(21, 25),
            .shutter = within(16, 22),
            .sky_image = within(17, 25),
            .dispersion = within(18, 19),
            .rough = chapter == 6 || within(13, 26)};
}

/// Reads and prepares the scene that the options name. Size, samples and depth in the options
/// replace those of the scene. Throws for what refuse_features() names.
Scene load(const RenderOptions& options, Features features);

/// Puts stand-ins in the place of what refuse_features() would refuse, where there are any, and
/// adds them to those of the scene.
void stand_in_for_features(Scene& scene, Features features);

/// Throws InputError if the scene has a point or distant light: a path that finds light only by
/// random hits never finds it.
void refuse_delta_lights(const Scene& scene);

/// Throws InputError if the scene has a lens, moving shapes, a sky image, dispersive glass or rough
/// conductors, and the chapter's `features` do not support it. stand_ins: it has a stand-in for
/// each that there is one for.
void refuse_features(const Scene& scene, Features features, bool stand_ins = false);

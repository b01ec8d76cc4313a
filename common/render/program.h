// What the program of a chapter does: loads a scene and renders it.
#pragma once
#include "common/path/method.h"
#include "common/render/options.h"

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
/// replace those of the scene. Throws as fit_features() and check_outputs() do, before any work.
Scene load(const RenderOptions& options, Features features);

/// Throws InputError if the scene has a point or distant light: a path that finds light only by
/// random hits never finds it.
void refuse_delta_lights(const Scene& scene);

/// Renders the scene or explains one path, and writes what the options ask for. Returns the exit
/// code.
int render(const Scene& scene, const RenderOptions& options, const Method& method);

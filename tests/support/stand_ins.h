// Stand-ins for scenes and for a chapter's trace(), where only the loop around them is tested.
#pragma once
#include "common/path/sampler.h"
#include "common/recording/recorder.h"
#include "tests/support/scenes.h"

inline Scene empty_scene(int width, int height, int spp) {
    Scene scene = scene_of(
        "Camera \"perspective\"\nWorldBegin\nLightSource \"infinite\"\n"
        "Shape \"sphere\"\n");
    scene.width = width;
    scene.height = height;
    scene.spp = spp;
    return scene;
}

/// Smooth in two dimensions, rough in a third: what stratification gains is in between.
inline Rgb smooth_and_rough(const Scene&, Ray, Sampler& sampler, Recorder&) {
    Vec2 u = sampler.u2(), v = sampler.u2();
    float L = u.x * u.x + u.y + (v.x + v.y < 0.3f ? 1.0f : 0.0f);
    return {L, 2 * L, L / 2};
}

// Where a path from the camera begins.
#pragma once
#include "common/path/sampler.h"
#include "common/scene/camera.h"

struct CameraSample {
    Ray ray;
    Vec2 film;  // the point that the ray goes through, in pixels from the top left
};

/// A ray through a random point of pixel (x, y), by the first two numbers of a sample. All points
/// are equally likely: the mean of what comes along the rays is the pixel of a box filter.
/// `centre`: always through the middle, which is a mistake that chapter 15 shows.
///
/// tested by  "identity: a camera sample is the ray through its pixel, at the next two numbers"
inline CameraSample camera_sample(const CameraView& view, int x, int y, Sampler& sampler,
                                  bool centre = false) {
    Vec2 u = sampler.u2();
    if (centre) u = {0.5f, 0.5f};
    Vec2 film = {static_cast<float>(x) + u.x, static_cast<float>(y) + u.y};
    return {camera_ray(view, film), film};
}

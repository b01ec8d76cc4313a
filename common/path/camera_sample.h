// Where a path from the camera begins.
#pragma once
#include "common/path/sampler.h"
#include "common/scene/camera.h"

/// Starts sample `number` of a pixel. Half 1 of the samples, and audits, have random numbers of
/// their own: of a key that is no pixel's.
inline void start_sample(Sampler& sampler, size_t pixel, int half, uint32_t number) {
    constexpr uint32_t another_key = 1u << 31;
    sampler.start(static_cast<uint32_t>(pixel) | (half == 1 ? another_key : 0), number);
}

struct CameraSample {
    Ray ray;
    Vec2 film;  // the point that the ray goes through, in pixels from the top left
};

/// A ray through a random point of pixel (x, y), by the first two numbers of a sample. All points
/// are equally likely: the mean of what comes along the rays is the pixel of a box filter.
/// `centre`: always through the middle, a mistake that chapter 16 shows.
///
/// tested by  "identity: a camera sample is the ray through its pixel, at the next two numbers"
inline CameraSample camera_sample(const CameraView& view, int x, int y, Sampler& sampler,
                                  bool centre = false) {
    Vec2 u = sampler.u2();
    if (centre) u = {0.5f, 0.5f};
    Vec2 film = {static_cast<float>(x) + u.x, static_cast<float>(y) + u.y};
    return {camera_ray(view, film), film};
}

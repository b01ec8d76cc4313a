// Where a path from the camera begins.
#pragma once
#include "common/path/sampler.h"
#include "common/scene/camera.h"

/// Starts sample `number` of a pixel. Samples of half 1, and audits, have random numbers of their
/// own, from a key that no pixel has.
inline void start_sample(Sampler& sampler, size_t pixel, int half, uint32_t number) {
    constexpr uint32_t another_key = 1u << 31;
    sampler.start(static_cast<uint32_t>(pixel) | (half == 1 ? another_key : 0), number);
}

struct CameraSample {
    Ray ray;
    Vec2 film;  // the point that the ray passes, in pixels from the top left
};

/// A ray through a uniformly distributed point of pixel (x, y), from the first two numbers of a
/// sample. The mean over such rays is the pixel's average: a box filter. `centre`: always through
/// the pixel's centre, a mistake that chapter 16 shows.
///
/// tested by  "identity: a camera sample is the ray through its pixel, at the next two numbers"
inline CameraSample camera_sample(const CameraView& view, int x, int y, Sampler& sampler,
                                  bool centre = false) {
    Vec2 u = sampler.u2();
    if (centre) u = {0.5f, 0.5f};
    Vec2 film = {static_cast<float>(x) + u.x, static_cast<float>(y) + u.y};
    return {camera_ray(view, film), film};
}

// A picture of how much work each pixel is.
#pragma once
#include "common/picture/image.h"
#include "common/scene/camera.h"
#include "common/scene/scene.h"

/// The ray through the middle of pixel number i, counted row by row.
inline Ray pixel_ray(const Scene& scene, int i) {
    CameraView view = camera_view(scene.camera, scene.width, scene.height);
    return camera_ray(view, {static_cast<float>(i % scene.width) + 0.5f,
                             static_cast<float>(i / scene.width) + 0.5f});
}

/// work(ray) of every pixel, from black (none) by blue, green and red to white (`most`).
template <class Work>
Image heat_map(const Scene& scene, float most, const Work& work) {
    Image image(scene.width, scene.height);
    for (int i = 0; i < scene.width * scene.height; i++) {
        float h = 4 * work(pixel_ray(scene, i)) / most;
        auto ramp = [&](float from) { return std::clamp(h - from, 0.0f, 1.0f); };
        image.at(i % scene.width, i / scene.width) = {ramp(2), ramp(1) - ramp(2) + ramp(3),
                                                      ramp(0) - ramp(1) + ramp(3)};
    }
    return image;
}

/// Calls trace(ray) for every stride-th pixel; returns how many.
template <class Trace>
double for_pixels(const Scene& scene, int stride, const Trace& trace) {
    int rays = 0;
    for (int i = 0; i < scene.width * scene.height; i += stride, rays++) trace(pixel_ray(scene, i));
    return rays;
}

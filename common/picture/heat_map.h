// A picture of how much work each pixel is.
#pragma once
#include "common/picture/image.h"
#include "common/scene/camera.h"
#include "common/scene/scene.h"

/// The ray through the middle of pixel number i, counted row by row.
inline Ray pixel_ray(const Scene& scene, const CameraView& view, int i) {
    return camera_ray(view, {static_cast<float>(i % scene.width) + 0.5f,
                             static_cast<float>(i / scene.width) + 0.5f});
}

/// The rays through every stride-th pixel.
inline std::vector<Ray> pixel_rays(const Scene& scene, size_t stride) {
    CameraView view = camera_view(scene.camera, scene.width, scene.height);
    std::vector<Ray> rays;
    int64_t pixels = int64_t{scene.width} * scene.height;
    for (int64_t i = 0; i < pixels; i += static_cast<int64_t>(stride)) {
        rays.push_back(pixel_ray(scene, view, static_cast<int>(i)));
    }
    return rays;
}

/// work(ray) of every pixel, from black (none) by blue, green and red to white (`most`).
template <class Work>
Image heat_map(const Scene& scene, float most, const Work& work) {
    Image image(scene.width, scene.height);
    CameraView view = camera_view(scene.camera, scene.width, scene.height);
    for (int i = 0; i < scene.width * scene.height; i++) {
        float h = 4 * work(pixel_ray(scene, view, i)) / most;
        auto ramp = [&](float from) { return std::clamp(h - from, 0.0f, 1.0f); };
        image.at(i % scene.width, i / scene.width) = {ramp(2), ramp(1) - ramp(2) + ramp(3),
                                                      ramp(0) - ramp(1) + ramp(3)};
    }
    return image;
}

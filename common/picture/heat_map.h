// A picture of the work for each pixel, in false colours.
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
    size_t pixels = static_cast<size_t>(scene.width) * static_cast<size_t>(scene.height);
    for (size_t i = 0; i < pixels; i += stride)
        rays.push_back(pixel_ray(scene, view, static_cast<int>(i)));
    return rays;
}

/// The numbers in the red channel as colours, from black (none) by blue, green and red to white
/// (`most` or more).
inline Image heat_map(Image numbers, float most) {
    for (Rgb& pixel : numbers.pixels) {
        float h = 4 * pixel.r / most;
        auto ramp = [&](float from) { return std::clamp(h - from, 0.0f, 1.0f); };
        pixel = {ramp(2), ramp(1) - ramp(2) + ramp(3), ramp(0) - ramp(1) + ramp(3)};
    }
    return numbers;
}

/// work(ray) of every pixel, as a heat map.
template <class Work>
Image heat_map(const Scene& scene, float most, const Work& work) {
    Image image(scene.width, scene.height);
    CameraView view = camera_view(scene.camera, scene.width, scene.height);
    for (int i = 0; i < scene.width * scene.height; i++) {
        image.at(i % scene.width, i / scene.width).r = work(pixel_ray(scene, view, i));
    }
    return heat_map(std::move(image), most);
}

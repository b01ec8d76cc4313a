// taught by chapter 05
// The pinhole camera.
#pragma once
#include "common/scene/scene.h"

/// The camera made ready for one picture size: film point (px, py), in pixels from the top left,
/// is seen along corner + px dx + py dy.
struct CameraView {
    Vec3 o, corner, dx, dy;
};

/// Lays the film at distance 1 in front of the camera.
///
///   half the shorter side = tan(fov / 2);  the longer side is as much longer as the picture's
///
/// source  pbrt-v4's "perspective" camera: left-handed, x right, y up, z forward
inline CameraView camera_view(const Camera& camera, int width, int height) {
    float aspect =
        camera.frame_aspect.value_or(static_cast<float>(width) / static_cast<float>(height));
    std::array<float, 4> window = {-1, 1, -1, 1};
    if (aspect > 1) window = {-aspect, aspect, -1, 1};
    if (aspect < 1) window = {-1, 1, -1 / aspect, 1 / aspect};
    auto [x0, x1, y0, y1] = camera.screen_window.value_or(window);

    float half = static_cast<float>(std::tan(double{camera.fov * pi / 360}));
    Vec3 right = half * camera.right, up = half * camera.up;
    return {camera.o, camera.forward + x0 * right + y1 * up,
            (x1 - x0) / static_cast<float>(width) * right,
            (y0 - y1) / static_cast<float>(height) * up};
}

/// The ray from the pinhole through the film point, in pixels.
inline Ray camera_ray(const CameraView& view, Vec2 film) {
    return {view.o, normalize(view.corner + film.x * view.dx + film.y * view.dy)};
}

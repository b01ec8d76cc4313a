// What the camera sees of a scene: the surfaces that warnings look at.
#pragma once
#include <vector>

#include "common/material/metal.h"
#include "common/scene/camera.h"
#include "common/scene/intersect.h"

/// Whether a surface reflects light, and is neither mirror nor glass.
inline bool is_receiver(const Material& m) {
    return !is_specular(m) &&
           !is_black(is_rough(m) ? fresnel_conductor(1, m.eta, m.k) : m.reflectance);
}

/// What rays through the middles of all pixels meet.
struct InView {
    double pixels = 0, hits = 0, backs = 0;   // numbers of rays; those that meet a back side
    double mirrors = 0, receivers = 0;        // mirrors and glass; see is_receiver()
    std::vector<std::pair<Ray, Hit>> points;  // about 1000 of the receivers
};
inline InView in_view(const Scene& scene) {
    InView seen;
    CameraView view = camera_view(scene.camera, scene.width, scene.height);
    size_t width = static_cast<size_t>(scene.width), height = static_cast<size_t>(scene.height);
    size_t every = 1 + width * height / 1000;
    for (size_t i = 0; i < width * height; i++) {
        Vec2 middle = {static_cast<float>(i % width) + 0.5f, static_cast<float>(i / width) + 0.5f};
        Ray ray = camera_ray(view, middle);
        std::optional<Hit> hit = intersect(scene, ray);
        seen.pixels++;
        if (!hit) continue;
        seen.hits++, seen.backs += !hit->front;
        seen.mirrors += is_specular(*hit->material);
        if (!is_receiver(*hit->material)) continue;
        if (static_cast<size_t>(seen.receivers++) % every == 0) seen.points.emplace_back(ray, *hit);
    }
    return seen;
}

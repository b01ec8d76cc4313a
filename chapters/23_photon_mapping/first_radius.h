// Chapter 23: the radius in which photons count, by their density and by the size of pixels.
#pragma once
#include "chapters/23_photon_mapping/photon_map.h"
#include "common/path/camera_sample.h"
#include "common/path/light_paths.h"

namespace ch23 {

/// The width of a pixel where the camera sees surfaces, in m: the median over paths through a grid
/// of film points, which follow mirrors and glass to another surface. A smaller picture counts as
/// one of 128x128 pixels, since its light is no less sharp.
///
///   width = length of the path * sqrt(solid angle of the pixel)
///
/// tested by  "truth: the first radius of even photons, ...", to 3 %
inline float pixel_width(const Scene& scene) {
    constexpr int side = 32;  // of the grid
    CameraView view = camera_view(scene.camera, scene.width, scene.height);
    float pixels = static_cast<float>(scene.width) * static_cast<float>(scene.height);
    float part = std::min(pixels / (128 * 128), 1.0f);
    float pixel = std::sqrt(part * length(cross(view.dx, view.dy)));  // its width at distance 1
    float step_x = static_cast<float>(scene.width) / side;
    float step_y = static_cast<float>(scene.height) / side;
    std::vector<float> widths;
    Sampler sampler(SamplerType::independent, 0, 1);
    for (int i = 0; i < side * side; i++) {
        start_sample(sampler, static_cast<size_t>(i), 0, 0);
        float row = static_cast<float>(i / side), column = static_cast<float>(i % side);
        Ray ray = camera_ray(view, {(column + 0.5f) * step_x, (row + 0.5f) * step_y});
        float distance = 0;
        std::optional<Hit> x = intersect(scene, ray);
        for (int depth = 0; x && is_specular(*x->material) && depth < scene.max_depth; depth++) {
            distance += length(x->p - ray.o);
            float u1 = sampler.u1();
            ray = spawn_ray(*x, sample_bsdf(*x, -ray.d, u1, sampler.u2()).wi);
            x = intersect(scene, ray);
        }
        if (x) widths.push_back(pixel * (distance + length(x->p - ray.o)));
    }
    if (widths.empty()) return scene.radius / 100;
    auto median = widths.begin() + static_cast<std::ptrdiff_t>(widths.size() / 2);
    std::nth_element(widths.begin(), median, widths.end());
    return *median;
}

/// The first radius: within it a photon of a caustic has 50 others of any kind around it, on
/// average; at most the radius of the maps, 3.6 pixels. Where there are no caustics, all photons
/// count. `share`: how many of a pass's light paths made the maps.
///
///   mean over caustic photons of the number of others nearer than r = 50 share
///
/// tested by  "truth: the first radius of even photons, ...", to 6 %
inline float first_radius(const PhotonMaps& maps, double share) {
    constexpr size_t most = 500;  // photons to count from: enough for a mean
    const PhotonMap& sharp = maps.caustic.size() > 0 ? maps.caustic : maps.global;
    std::span<const Photon> photons = sharp.photons();
    size_t step = photons.size() / most + 1, from = 0;
    std::vector<float> distances;
    for (size_t i = 0; i < photons.size(); i += step) {
        from++;
        maps.global.for_each_near(photons[i].p,
                                  [&](const Photon&, Vec3 v) { distances.push_back(length(v)); });
    }
    size_t wanted = static_cast<size_t>((1 + 50 * share) * static_cast<double>(from));
    if (wanted >= distances.size()) return maps.global.radius();
    auto last = distances.begin() + static_cast<std::ptrdiff_t>(wanted);
    std::nth_element(distances.begin(), last, distances.end());
    return *last;
}

}  // namespace ch23

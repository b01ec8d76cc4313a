// The scene in flat colours, for drawings.
#pragma once
#include "common/picture/image.h"
#include "common/scene/camera.h"
#include "common/scene/intersect.h"

inline Rgb flat_colour(const Hit& x) {
    switch (x.material->type) {
        case MaterialType::diffuse: return x.material->reflectance;
        case MaterialType::conductor: return {0.45f, 0.45f, 0.5f};
        case MaterialType::dielectric: return {0.5f, 0.7f, 0.75f};
    }
    return {};
}

/// What the ray of each pixel meets, lit along the ray; lamps are yellow.
///
/// ray_of  (pixel) -> Ray; (0.5, 0.5) is the middle of the first pixel
/// reach, m: what is this far away is half as bright
template <class RayOf>
Image preview(const Scene& scene, int width, int height, const RayOf& ray_of,
              float reach = infinity) {
    constexpr Rgb sky = {0.8f, 0.85f, 0.9f}, lamp = {1, 0.75f, 0.05f};
    Image image(width, height);
    for (int y = 0; y < height; y++) {
        for (int x = 0; x < width; x++) {
            Ray ray = ray_of(Vec2{static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f});
            std::optional<Hit> hit = intersect(scene, ray);
            Rgb& pixel = image.at(x, y);
            if (!hit) {
                pixel = sky;
            } else if (!is_black(emission(scene, *hit))) {
                pixel = lamp;
            } else {
                pixel =
                    (0.25f - 0.75f * dot(ray.d, hit->n)) / (1 + hit->t / reach) * flat_colour(*hit);
            }
        }
    }
    return image;
}

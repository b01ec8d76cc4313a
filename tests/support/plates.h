// Veach's plates, one plate and one lamp at a time: what each way of looking for light is good at.
#pragma once
#include "tests/support/estimators.h"

/// One plate of scenes/veach-mis.pbrt that shows one lamp alone.
///
/// plate  0: nearly a mirror, to 3: matt      lamp  0: large and dim, to 3: small and bright
struct PlateAndLamp {
    Scene scene;  // with direct light only
    Ray ray;      // from the camera to where a mirror would show the middle of the lamp

    PlateAndLamp(size_t plate, size_t lamp) {
        scene = parse_scene("plates", read_file("scenes/veach-mis.pbrt"), nullptr);
        for (Shape& shape : scene.shapes) shape.light = shape.light == int(lamp) ? 0 : -1;
        scene.lights = {scene.lights[lamp]};
        prepare(scene, 1);
        scene.max_depth = 1;

        constexpr Vec3 camera = {0, 2.2f, -14.5f};
        constexpr Vec3 middle[] = {
            {0, -2.25f, 0}, {0, -2.95f, -1.05f}, {0, -3.45f, -2.3f}, {0, -3.75f, -3.75f}};
        Vec3 c = middle[plate], n = intersect(scene, {camera, normalize(c - camera)})->n;
        Vec3 to_lamp = scene.light_shapes[0].centre - c;
        Vec3 mirrored = c + to_lamp - 2 * dot(to_lamp, n) * n;
        ray = {camera, normalize(mirrored - camera)};
        constexpr float alpha[] = {0.005f, 0.02f, 0.05f, 0.1f};
        REQUIRE(intersect(scene, ray)->material->alpha == alpha[plate]);
    }

    RunningStats sample(const Method& trace, int paths, uint32_t seed = 1) const {
        return repeat(scene, ray, trace, paths, seed);
    }
};

/// Variance of one sample over the squared mean.
inline double relative_variance(const RunningStats& s) {
    return s.variance() / (s.mean() * s.mean());
}

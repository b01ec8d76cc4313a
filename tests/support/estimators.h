// What the chapters that sample lights (09 to 13) are compared with: a floor under lights whose
// irradiance is known, and paths of one chapter against those of another, class by class.
#pragma once
#include "tests/support/gates.h"
#include "tests/support/scenes.h"

/// Black area lights of radiance 1 from here on.
inline const std::string shining =
    "AreaLightSource \"diffuse\" Material \"diffuse\" \"rgb reflectance\" [0 0 0]\n";

/// A floor y = 0 that reflects all, under this light: its radiance is irradiance / pi.
Scene floor_under(const std::string& light);
/// Sees the floor at the origin, from so near that nothing comes in between.
inline const Ray onto_origin = {{0, 1e-4f, 0}, {0, -1, 0}};

/// The floor at the origin.
Hit origin_of(const Scene& scene);

/// The unit square at height h, facing down; x, z: where its middle is.
std::string unit_square(double h, double x = 0, double z = 0);
/// The disk of radius R at height h, facing down; x: where its middle is.
std::string disk(double R, double h, double x = 0);

/// The inside of a ball whose wall emits 1 and reflects the share a.
Scene closed_sphere(double a, int max_depth);

/// The green channel of one ray, over and over.
RunningStats repeat(const Scene& scene, const Ray& ray, const Method& trace, int paths,
                    uint32_t seed = 1, double scale = 1);

inline Measured measured(const RunningStats& s) { return {s.mean(), s.standard_error()}; }

/// Samples of the irradiance at the origin of floor_under().
RunningStats irradiance(const Scene& scene, const Method& trace, int paths, uint32_t seed = 1);

/// The mean is within 5 of its own standard errors, and those are at most a share `relative_se`:
/// for estimators whose samples are bounded by a few times their mean.
void check_bounded(const RunningStats& s, double truth, double relative_se);

/// relMSE of one sample for each pixel: the mean over the film of variance / (mean^2 + 0.01), with
/// the means of blocks of 8 x 8 pixels: those of single pixels are too noisy to be divided by.
double rel_mse(const Film& film);
inline double rel_mse(const Scene& scene, const Method& trace, int spp) {
    return rel_mse(film_of(scene, trace, spp).film);
}

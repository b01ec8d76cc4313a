// Light that paths from the camera rarely find: reflected by metal that is nearly a mirror.
#pragma once
#include "common/picture/film.h"
#include "common/scene/scene.h"

/// Whether metal is so smooth that too few of `paths` paths find the light that it reflects.
///
/// A path finds a light reflected in metal if a sampled point of the light lies in the metal's
/// lobe, or if a sampled direction of the lobe hits the light. The expected number of hits of N
/// paths:
///
///   hits = N (alpha^2 + size),   size = A / (4 pi d^2),   of a sphere  r^2 / d^2
///
/// Measured with a metal plate beside a floor, a lamp of 0.5 to 9 degrees and alpha from 0.001 to
/// 0.1: intervals cover the truth in 10 to 87 % of the runs for hits up to 8, in 93 % and more from
/// 25 on.
inline bool is_nearly_mirror(const Material& m, double paths, double size = 0) {
    constexpr double few_hits = 20;
    double alpha = static_cast<double>(m.alpha);
    return is_rough(m) && paths * (alpha * alpha + size) < few_hits;
}

/// The contribution to the picture of light that reaches a visible surface only via near mirrors.
/// Estimated from a few thousand paths from the lights, which find it easily. Infinite (that is,
/// unknown) if the light is a small part of a sky image.
///
/// meets_lights  whether BSDF samples of the metal that hit a light count, or only light samples
/// tested by  "failure: metal that is nearly a mirror hides light, and a warning says so"
double light_by_nearly_mirrors(const Scene& scene, double paths, bool meets_lights);

/// The pixels that show near mirrors, in a picture by paths that start at the lights.
struct NearlyMirrorsSeen {
    double share = 0;     // of the picture
    double found = 0;     // their contribution to its mean, in the film
    double expected = 0;  // the same, by paths from the camera
    double error = 0;     // of what is expected
    double hits = 0;      // number of these paths that hit a light via a near mirror
};

/// tested by  "failure: paths from lights miss what nearly mirrors show, and a warning says so"
NearlyMirrorsSeen nearly_mirrors_seen(const Scene& scene, const Film& film);

// Light that paths from the camera rarely find: by way of metal that is nearly a mirror.
#pragma once
#include "common/picture/film.h"
#include "common/scene/scene.h"

/// Whether metal is so smooth that of so many paths too few find what it reflects.
///
/// A path finds a light in metal where a point of the light, drawn by aiming, lies in the metal's
/// lobe, or where a direction of the lobe meets the light. Of N paths about so many do:
///
///   hits = N (alpha^2 + size),   size = A / (4 pi d^2),   of a ball  r^2 / d^2
///
/// Measured with a metal plate beside a floor, a lamp of 0.5 to 9 degrees and alpha from 0.001 to
/// 0.1: intervals cover the truth in 10 to 87 % of the runs for hits up to 8, in 93 % and more from
/// 25 on.
inline bool is_nearly_mirror(const Material& m, double paths, double size = 0) {
    constexpr double few_hits = 20;
    double alpha = static_cast<double>(m.alpha);
    return is_rough(m) && paths * (alpha * alpha + size) < few_hits;
}

/// How bright the picture is by light that comes from a light by way of nearly mirrors alone to a
/// surface in view: from a few thousand paths from the lights, which find it easily. Infinite (that
/// is: unknown) where the light is a small part of a picture of the sky.
///
/// meets_lights  whether directions of the metal that meet a light count, or aiming alone does
/// tested by  "failure: metal that is nearly a mirror hides light, and a warning says so"
double light_by_nearly_mirrors(const Scene& scene, double paths, bool meets_lights);

/// The pixels of a picture that show nearly mirrors, where paths begin at the lights.
struct NearlyMirrorsSeen {
    double share = 0;     // of the picture
    double found = 0;     // what they add to its mean, in the film
    double expected = 0;  // the same, by paths from the camera
    double error = 0;     // of what is expected
    double hits = 0;      // how many of these paths met a light by way of a nearly mirror
};

/// tested by  "failure: paths from lights miss what nearly mirrors show, and a warning says so"
NearlyMirrorsSeen nearly_mirrors_seen(const Scene& scene, const Film& film);

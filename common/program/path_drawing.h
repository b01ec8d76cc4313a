// A path drawn into its scene.
#pragma once
#include <string>
#include <vector>

#include "common/recording/recorder.h"

/// An SVG with two panels: the scene as the camera sees it, and from above, each with the path and
/// its shadow rays. eye: where the path from the eye begins; rays: all that it traced.
std::string draw_path(const Scene& scene, Vec3 eye, const std::vector<PathVertex>& path,
                      const std::vector<TracedRay>& rays);

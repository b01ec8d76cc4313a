// A drawing of a path in its scene.
#pragma once
#include <string>
#include <vector>

#include "common/recording/recorder.h"
#include "common/scene/intersect.h"

/// An SVG with two panels: the scene seen by the camera, and from above, each with the path and its
/// shadow rays. eye: start of the path from the eye; rays: all rays that the path traced.
std::string draw_path(const Scene& scene, Vec3 eye, const std::vector<PathVertex>& path,
                      const std::vector<TracedRay>& rays);

// A path drawn into its scene.
#pragma once
#include <string>
#include <vector>

#include "common/path/path_log.h"
#include "common/scene/scene.h"

/// The scene from the front and from above, side by side, with the path from the eye on: an SVG.
std::string draw_path(const Scene& scene, Vec3 eye, const std::vector<PathVertex>& path);

// A drawing of a path in its scene.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "common/picture/image.h"
#include "common/recording/path_story.h"

/// An SVG with two panels: the scene seen by the camera, and from above, each with the path and its
/// shadow rays. eye: start of the path from the eye; rays: all rays that the path traced.
std::string draw_path(const Scene& scene, Vec3 eye, const std::vector<PathVertex>& path,
                      const std::vector<TracedRay>& rays);

/// The scene in flat colours: what the ray of each pixel meets, lit along the ray; lamps are
/// yellow.
///
/// ray_of  (pixel) -> Ray; (0.5, 0.5) is the middle of the first pixel
/// reach, m: what is this far away is half as bright
Image preview(const Scene& scene, int width, int height, const std::function<Ray(Vec2)>& ray_of,
              float reach = infinity);

// The outlines of a scene, for drawings.
#pragma once
#include <utility>
#include <vector>

#include "common/picture/image.h"
#include "common/scene/scene.h"

using Segment = std::pair<Vec3, Vec3>;

/// The lines that show the shape of the scene from direction `axis` (unit): edges where faces meet
/// at an angle or end, and contours of round shapes; no diagonals of flat faces. Lamps have lines
/// of their own. Moving shapes are drawn at their first position.
std::vector<Segment> outline(const Scene& scene, Vec3 axis);
std::vector<Segment> lamp_outline(const Scene& scene, Vec3 axis);

/// The scene seen from the pinhole and lit from there, in flat colours; lamps are yellow.
Image preview(const Scene& scene, int width, int height);

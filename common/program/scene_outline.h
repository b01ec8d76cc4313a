// A scene without its pictures: what a drawing shows of it.
#pragma once
#include <utility>
#include <vector>

#include "common/picture/image.h"
#include "common/scene/scene.h"

using Segment = std::pair<Vec3, Vec3>;

/// The lines that tell the form of the scene to who looks along `axis` (unit): edges where faces
/// meet at an angle or end, and where a round form turns away. No diagonal of a flat face. Lamps
/// have lines of their own. What moves is where it begins.
std::vector<Segment> outline(const Scene& scene, Vec3 axis);
std::vector<Segment> lamp_outline(const Scene& scene, Vec3 axis);

/// The scene as the pinhole sees it, in flat colours, lit from there; lamps are yellow.
Image preview(const Scene& scene, int width, int height);

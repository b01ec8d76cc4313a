// Surfaces that lie in one place, where a scene does not say which of them a ray meets.
#pragma once
#include "common/scene/scene.h"

/// A note for each two Shape directives of which one shines and overlaps the other in one plane, or
/// of which faces are the same: rounding and their order then decide what a ray meets there.
///
/// Shapes that move are left out. It takes at most some tenths of a second: after 30 million pairs
/// of a face that shines and another one, only those with the same box are compared.
/// tested by  "truth: surfaces in one place are named, and no others"
std::vector<std::string> notes_of_coincident(const Scene& scene);

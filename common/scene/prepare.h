// What a scene needs before a ray is sent into it, and what is wrong with it.
#pragma once
#include "common/base/progress.h"
#include "common/scene/scene.h"

/// Makes a scene ready to trace: its hierarchy, its size, its normals, the shapes of its lights,
/// and the sum of its skies. From then on it is only read.
/// `report` hears how far it is.
void prepare(Scene& scene, int threads, const Report& report = {});

/// Primitive number `prim` of the scene, as a part of a light.
Emitter emitter_of(const Scene& scene, uint32_t prim);
/// m^2
float area_of(const Emitter& e);

/// A note for each two Shape directives of which one shines and overlaps the other in one plane, or
/// of which faces are the same: rounding and their order then decide what a ray meets there.
///
/// Shapes that move are left out. It takes at most some tenths of a second: after 30 million pairs
/// of a face that shines and another one, only those with the same box are compared.
/// tested by  "truth: surfaces in one place are named, and no others"
std::vector<std::string> notes_of_coincident(const Scene& scene);

// What a scene needs before a ray is sent into it.
#pragma once
#include "common/base/progress.h"
#include "common/scene/scene.h"

/// Makes a scene ready to trace: its hierarchy, its size, its normals, the shapes of its lights,
/// and the sum of its skies. From then on it is only read.
/// `report` hears how far it is.
void prepare(Scene& scene, int threads, const Report& report = {});

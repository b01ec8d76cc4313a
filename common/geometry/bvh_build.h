// Builds the hierarchy of bounding boxes (chapter 06).
#pragma once
#include "common/base/progress.h"
#include "common/geometry/bvh.h"

/// Builds the hierarchy over all primitives. It does not depend on the number of threads, to the
/// last bit. `report` hears how far it is.
Bvh build_bvh(const Geometry& geometry, int threads, const Report& report = {});

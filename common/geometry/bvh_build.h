// Builds the hierarchy of bounding boxes (chapter 06).
#pragma once
#include "common/base/report.h"
#include "common/geometry/bvh.h"

/// The same hierarchy for any number of threads. `report` hears how far it is.
Bvh build_bvh(const Geometry& geometry, int threads, const Report& report = {});

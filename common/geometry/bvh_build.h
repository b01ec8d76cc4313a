// Builds the hierarchy of bounding boxes (chapter 05).
#pragma once
#include "common/geometry/bvh.h"

/// The same hierarchy for any number of threads.
Bvh build_bvh(const Geometry& geometry, int threads);

// Contributions of a path to pixels other than its own.
#pragma once
#include <vector>

#include "common/base/vec.h"

/// The contribution of a path from a light to the pixel in which the camera sees it.
struct Splat {
    size_t pixel;
    Rgb L;
};
using Splats = std::vector<Splat>;

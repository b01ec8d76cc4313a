// What a path brings to pixels other than the one that it is a sample of.
#pragma once
#include <vector>

#include "common/base/vec.h"

/// A path that began at a light has met the camera in this pixel.
struct Splat {
    size_t pixel;
    Rgb L;
};
using Splats = std::vector<Splat>;

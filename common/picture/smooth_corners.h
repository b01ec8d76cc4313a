// One colour for each triangle, shown smoothly.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "common/base/vec.h"

using Triangles = std::vector<std::array<Vec3, 3>>;     // corners
using CornerColours = std::vector<std::array<Rgb, 3>>;  // of each triangle, at its corners

/// Whether one surface goes on from triangle i to triangle j. Any thread may ask.
using GoesOn = std::function<bool(uint32_t i, uint32_t j)>;

/// Colours at the corners: the mean of the triangles around, by area, but only where the surface
/// goes on. That alone would flatten what rises and falls; so what a triangle's corners miss of its
/// own colour is spread among them. None is negative.
///
/// size, m: corners that are nearer to each other are one
/// tested by  "truth: corners follow radiosity that rises evenly, and stop at an edge"
CornerColours smooth_corners(const Triangles& triangles, const std::vector<Rgb>& colours,
                             float size, const GoesOn& goes_on, int threads);

// What is drawn: points and curves in a part of a picture, sheets of many pictures with words, the
// work for each pixel in false colours, and one colour for each triangle, shown smoothly.
#pragma once
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "common/picture/image.h"
#include "common/scene/camera.h"
#include "common/scene/scene.h"

/// A rectangle of an image with its own coordinates: x to the right, y up.
struct Panel {
    Image& image;
    int left, top, width, height;      // pixels
    Vec2 low = {0, 0}, high = {1, 1};  // the coordinates of two corners

    /// A disc of `radius` pixels around p, clipped to the panel.
    void dot(Vec2 p, float radius, Rgb color) const {
        Vec2 centre = {(p.x - low.x) / (high.x - low.x) * static_cast<float>(width),
                       (high.y - p.y) / (high.y - low.y) * static_cast<float>(height)};
        if (!(std::abs(centre.x) < 1e6f && std::abs(centre.y) < 1e6f)) return;
        int x0 = static_cast<int>(std::floor(centre.x - radius));
        int y0 = static_cast<int>(std::floor(centre.y - radius));
        int size = static_cast<int>(2 * radius) + 2;
        for (int y = std::max(0, y0); y <= std::min(height - 1, y0 + size); y++)
            for (int x = std::max(0, x0); x <= std::min(width - 1, x0 + size); x++) {
                float dx = static_cast<float>(x) + 0.5f - centre.x;
                float dy = static_cast<float>(y) + 0.5f - centre.y;
                if (dx * dx + dy * dy <= std::max(0.25f, radius * radius))
                    image.at(left + x, top + y) = color;
            }
    }

    /// color(p) for every pixel, p the coordinates of its centre.
    template <class Color>
    void fill(Color color) const {
        for (int y = 0; y < height; y++)
            for (int x = 0; x < width; x++) {
                float s = (static_cast<float>(x) + 0.5f) / static_cast<float>(width);
                float t = (static_cast<float>(y) + 0.5f) / static_cast<float>(height);
                image.at(left + x, top + y) =
                    color(Vec2{low.x + s * (high.x - low.x), high.y + t * (low.y - high.y)});
            }
    }

    /// A thin line from a to b.
    void line(Vec2 a, Vec2 b, Rgb color) const {
        float across = std::abs(b.x - a.x) / (high.x - low.x) * static_cast<float>(width);
        float along = std::abs(b.y - a.y) / (high.y - low.y) * static_cast<float>(height);
        int steps = 1 + static_cast<int>(std::min(2 * std::max(across, along), 1e4f));
        for (int i = 0; i <= steps; i++) {
            float t = static_cast<float>(i) / static_cast<float>(steps);
            dot({a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)}, 0.5f, color);
        }
    }

    /// The graph of y = f(x).
    template <class Function>
    void curve(Function f, Rgb color) const {
        float step = (high.x - low.x) / static_cast<float>(width);
        for (int i = 0; i < width; i++) {
            float x = low.x + (static_cast<float>(i) + 0.5f) * step;
            line({x, static_cast<float>(f(x))}, {x + step, static_cast<float>(f(x + step))}, color);
        }
    }
};

/// One picture of a sheet; of size 0: its place stays empty.
struct Tile {
    Image image;
    std::vector<std::string> lines;
};

/// The tiles, row by row from the top left, on grey. All have one size and as many lines.
Image sheet(const std::vector<Tile>& tiles, int columns);

/// The means of n x n pixels each; what is left over at the right and at the bottom is dropped.
Image shrunk(const Image& image, int n);

/// The ray through the middle of pixel number i, counted row by row.
inline Ray pixel_ray(const Scene& scene, const CameraView& view, int i) {
    return camera_ray(view, {static_cast<float>(i % scene.width) + 0.5f,
                             static_cast<float>(i / scene.width) + 0.5f});
}

/// The numbers in the red channel as colours, from black (none) by blue, green and red to white
/// (`most` or more).
inline Image heat_map(Image numbers, float most) {
    for (Rgb& pixel : numbers.pixels) {
        float h = 4 * pixel.r / most;
        auto ramp = [&](float from) { return std::clamp(h - from, 0.0f, 1.0f); };
        pixel = {ramp(2), ramp(1) - ramp(2) + ramp(3), ramp(0) - ramp(1) + ramp(3)};
    }
    return numbers;
}

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

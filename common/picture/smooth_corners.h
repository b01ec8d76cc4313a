// One colour for each triangle, shown smoothly.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <vector>

#include "common/base/parallel.h"
#include "common/base/vec.h"

using Triangles = std::vector<std::array<Vec3, 3>>;     // corners
using CornerColours = std::vector<std::array<Rgb, 3>>;  // of each triangle, at its corners

/// Whether one surface goes on from triangle i to triangle j. Any thread may ask.
using GoesOn = std::function<bool(uint32_t i, uint32_t j)>;

/// Of each corner of each triangle: the triangles around it that its surface goes on to, and
/// itself.
using Around = std::vector<std::array<std::vector<uint32_t>, 3>>;
inline Around find_around(const Triangles& triangles, float size, const GoesOn& goes_on,
                          int threads) {
    std::map<std::array<int64_t, 3>, std::vector<uint32_t>> corners;  // by where they are
    auto place = [&](Vec3 p) -> std::array<int64_t, 3> {
        return {std::llround(p.x / size), std::llround(p.y / size), std::llround(p.z / size)};
    };
    for (uint32_t i = 0; i < triangles.size(); i++)
        for (Vec3 p : triangles[i]) corners[place(p)].push_back(i);
    Around around(triangles.size());
    parallel_for(static_cast<int>(triangles.size()), threads, [&](int index) {
        uint32_t i = static_cast<uint32_t>(index);
        for (size_t c = 0; c < 3; c++)
            for (uint32_t j : corners.at(place(triangles[i][c])))
                if (j == i || goes_on(i, j)) around[i][c].push_back(j);
    });
    return around;
}

/// Where one of the corners is negative: brings them all nearer to the triangle's own colour, so
/// that none is, and their mean is that colour. (To put 0 in place of the negative would add
/// light.)
inline void keep_positive(std::array<Rgb, 3>& corner, float Rgb::*channel, float own) {
    float mean = 0, least = infinity;
    for (Rgb b : corner) mean += b.*channel / 3, least = std::min(least, b.*channel);
    if (least >= 0) return;
    float keep = mean - least > own ? own / (mean - least) : 1;
    for (Rgb& b : corner) b.*channel = std::max(0.0f, own + keep * (b.*channel - mean));
}

/// Colours at the corners: the mean of the triangles around, by area, but only where the surface
/// goes on. That alone would flatten what rises and falls; so what a triangle's corners miss of its
/// own colour is spread among them. None is negative.
///
/// size, m: corners that are nearer to each other are one
/// tested by  "truth: corners follow radiosity that rises evenly, and stop at an edge"
inline CornerColours smooth_corners(const Triangles& triangles, const std::vector<Rgb>& colours,
                                    float size, const GoesOn& goes_on, int threads) {
    constexpr int rounds = 4;
    size_t n = triangles.size();
    Around around = find_around(triangles, size, goes_on, threads);
    std::vector<float> areas;
    for (const auto& t : triangles) areas.push_back(length(cross(t[1] - t[0], t[2] - t[0])) / 2);
    CornerColours corner(n);
    std::vector<Rgb> missing = colours;
    for (int round = 0; round < rounds; round++) {
        std::vector<Rgb> left = missing;
        for (size_t i = 0; i < n; i++) {
            for (size_t c = 0; c < 3; c++) {
                float area = 0;
                Rgb sum;
                for (uint32_t j : around[i][c]) {
                    area += areas[j];
                    sum += areas[j] * missing[j];
                }
                corner[i][c] += sum / area;
                left[i] = left[i] - sum / (3 * area);
            }
        }
        missing = left;
    }
    for (size_t i = 0; i < n; i++)
        for (float Rgb::*channel : {&Rgb::r, &Rgb::g, &Rgb::b})
            keep_positive(corner[i], channel, colours[i].*channel);
    return corner;
}

#include "common/picture/smooth_corners.h"

#include <map>

#include "common/base/parallel.h"

namespace {

/// The triangles around each corner, found by where it is.
using Corner = std::array<int64_t, 3>;
Corner corner_at(Vec3 p, float size) {
    return {std::llround(p.x / size), std::llround(p.y / size), std::llround(p.z / size)};
}

/// Of each corner of each triangle: the triangles around it that its surface goes on to, and
/// itself.
using Around = std::vector<std::array<std::vector<uint32_t>, 3>>;
Around find_around(const Triangles& triangles, float size, const GoesOn& goes_on, int threads) {
    std::map<Corner, std::vector<uint32_t>> corners;
    for (uint32_t i = 0; i < triangles.size(); i++)
        for (Vec3 p : triangles[i]) corners[corner_at(p, size)].push_back(i);
    Around around(triangles.size());
    parallel_for(static_cast<int>(triangles.size()), threads, [&](int index) {
        uint32_t i = static_cast<uint32_t>(index);
        for (size_t c = 0; c < 3; c++) {
            for (uint32_t j : corners.find(corner_at(triangles[i][c], size))->second)
                if (j == i || goes_on(i, j)) around[i][c].push_back(j);
        }
    });
    return around;
}

/// Where one of the corners is negative: brings them all nearer to the triangle's own colour, so
/// that none is, and their mean is that colour. (To put 0 in place of the negative would add
/// light.)
void keep_positive(std::array<Rgb, 3>& corner, float Rgb::*channel, float own) {
    float mean = 0, least = infinity;
    for (Rgb b : corner) mean += b.*channel / 3, least = std::min(least, b.*channel);
    if (least >= 0) return;
    float keep = mean - least > own ? own / (mean - least) : 1;
    for (Rgb& b : corner) b.*channel = std::max(0.0f, own + keep * (b.*channel - mean));
}

float area_of(const std::array<Vec3, 3>& t) { return length(cross(t[1] - t[0], t[2] - t[0])) / 2; }

}  // namespace

CornerColours smooth_corners(const Triangles& triangles, const std::vector<Rgb>& colours,
                             float size, const GoesOn& goes_on, int threads) {
    constexpr int rounds = 4;
    size_t n = triangles.size();
    Around around = find_around(triangles, size, goes_on, threads);
    CornerColours corner(n);
    std::vector<Rgb> missing = colours;
    for (int round = 0; round < rounds; round++) {
        std::vector<Rgb> left = missing;
        for (size_t i = 0; i < n; i++) {
            for (size_t c = 0; c < 3; c++) {
                float area = 0;
                Rgb sum;
                for (uint32_t j : around[i][c]) {
                    area += area_of(triangles[j]);
                    sum += area_of(triangles[j]) * missing[j];
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

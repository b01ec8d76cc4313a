#include "common/picture/drawing.h"

#include <stb/stb_easy_font.h>

#include <algorithm>
#include <map>

#include "common/base/parallel.h"

constexpr int letter_scale = 2, line_height = 22, gap = 10;  // pixels
constexpr Rgb ink = {0, 0, 0}, paper = {0.6f, 0.6f, 0.6f};

Image shrunk(const Image& image, int n) {
    Image small(image.width / n, image.height / n);
    for (int y = 0; y < small.height * n; y++)
        for (int x = 0; x < small.width * n; x++)
            small.at(x / n, y / n) += image.at(x, y) / static_cast<float>(n * n);
    return small;
}

/// Words of black ink, 20 pixels high; returns their width in pixels.
static int write_words(Image& image, int left, int top, std::string words) {
    struct Corner {
        float x, y, z;
        unsigned char color[4];
    };
    std::vector<Corner> corners(40 * words.size() + 40);  // four for each stroke of a letter
    int strokes = stb_easy_font_print(0, 0, words.data(), nullptr, corners.data(),
                                      static_cast<int>(corners.size() * sizeof(Corner)));
    for (size_t i = 0; i < static_cast<size_t>(strokes); i++) {
        const Corner &a = corners[4 * i], &b = corners[4 * i + 2];
        auto to_pixels = [](float v) { return static_cast<int>(v) * letter_scale; };
        int x0 = left + to_pixels(a.x), x1 = std::min(left + to_pixels(b.x), image.width);
        int y0 = top + to_pixels(a.y), y1 = std::min(top + to_pixels(b.y), image.height);
        for (int y = y0; y < y1; y++)
            for (int x = x0; x < x1; x++) image.at(x, y) = ink;
    }
    return letter_scale * stb_easy_font_width(words.data());
}

Image sheet(const std::vector<Tile>& tiles, int columns) {
    int width = 0, height = 0, lines = 0;
    Image nowhere;
    for (const Tile& tile : tiles) {
        width = std::max(width, tile.image.width);
        height = std::max(height, tile.image.height);
        lines = std::max(lines, static_cast<int>(tile.lines.size()));
        for (const std::string& line : tile.lines)
            width = std::max(width, write_words(nowhere, 0, 0, line));
    }
    int rows = (static_cast<int>(tiles.size()) + columns - 1) / columns;
    int step_x = width + gap, step_y = height + lines * line_height + gap;
    Image all(columns * step_x + gap, rows * step_y + gap);
    std::fill(all.pixels.begin(), all.pixels.end(), paper);
    for (int i = 0; i < static_cast<int>(tiles.size()); i++) {
        const Tile& tile = tiles[static_cast<size_t>(i)];
        int left = gap + i % columns * step_x, top = gap + i / columns * step_y;
        for (int y = 0; y < tile.image.height; y++)
            for (int x = 0; x < tile.image.width; x++)
                all.at(left + x, top + y) = tile.image.at(x, y);
        top += height + 4;
        for (const std::string& line : tile.lines) {
            write_words(all, left, top, line);
            top += line_height;
        }
    }
    return all;
}

namespace {

/// Of each corner of each triangle: the triangles around it that its surface goes on to, and
/// itself.
using Around = std::vector<std::array<std::vector<uint32_t>, 3>>;
Around find_around(const Triangles& triangles, float size, const GoesOn& goes_on, int threads) {
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
void keep_positive(std::array<Rgb, 3>& corner, float Rgb::*channel, float own) {
    float mean = 0, least = infinity;
    for (Rgb b : corner) mean += b.*channel / 3, least = std::min(least, b.*channel);
    if (least >= 0) return;
    float keep = mean - least > own ? own / (mean - least) : 1;
    for (Rgb& b : corner) b.*channel = std::max(0.0f, own + keep * (b.*channel - mean));
}

}  // namespace

CornerColours smooth_corners(const Triangles& triangles, const std::vector<Rgb>& colours,
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

#include "common/picture/drawing.h"

#include <stb/stb_easy_font.h>

#include <algorithm>
#include <cstring>

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

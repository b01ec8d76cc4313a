// A sheet: many pictures in one, each with words below it.
#pragma once
#include <string>
#include <vector>

#include "common/picture/image.h"

/// One picture of a sheet; of size 0: its place stays empty.
struct Tile {
    Image image;
    std::vector<std::string> lines;
};

/// The tiles, row by row from the top left, on grey. All have one size and as many lines.
Image sheet(const std::vector<Tile>& tiles, int columns);

/// The means of n x n pixels each; what is left over at the right and at the bottom is dropped.
Image shrunk(const Image& image, int n);

/// Words of black ink, 20 pixels high; returns their width in pixels.
int write_words(Image& image, int left, int top, std::string words);

// The known scenes that any path tracer can render (quads, spheres, and one material each), their
// pictures as numbers (the means of their tiles), and what mistakes make of these.
#pragma once
#include "common/picture/image.h"
#include "tests/known/scenes.h"

/// Numbers of one scene: of its 4 x 4 tiles, row by row; of a coloured scene first those of red.
using Tiles = std::vector<Quantity>;

struct SmallScene {
    std::string name;       // of its files
    std::string pbrt = {};  // the scene, with one object on each line
    Tiles should = {};      // what its tiles should be
    int width = 16;         // pixels
    bool coloured = false;  // its channels differ
};

/// Those of tests/known/tiles.tsv.
const std::vector<SmallScene>& small_scenes();

/// Calls visit(x, y, channel) for each number of a picture of this size that belongs to a tile.
template <typename Visit>
void visit_tile(size_t tile, bool coloured, int width, int height, const Visit& visit) {
    int w = width / 4, h = height / 4, column = tile % 4, row = tile / 4 % 4;
    for (int y = row * h; y < (row + 1) * h; y++)
        for (int x = column * w; x < (column + 1) * w; x++)
            for (int c = 0; c < 3; c++)
                if (!coloured || c == static_cast<int>(tile / 16)) visit(x, y, c);
}
inline double channel(Rgb c, int i) { return double{i == 0 ? c.r : i == 1 ? c.g : c.b}; }

/// What a tile is compared with: what it should be, or where that is almost nothing (such a tile's
/// evidence is "dark") the mean of all, or 0.01.
double scale_of(const SmallScene& scene, size_t tile);
/// The name of a tile in evidence.
std::string key_of(const SmallScene& scene, size_t tile);

/// One number for each tile of each scene: measured over expected; of a tile that should be black,
/// what it brings. The key is "scene/tile", or "scene/tile dark".
using Evidence = std::map<std::string, Quantity>;
/// A mistake, and what it makes of each number. What is not in `predicted` is as it should be.
struct Hypothesis {
    std::string text;
    Evidence predicted;
};

/// The effects of mistakes that were planted (effects.tsv).
std::vector<Hypothesis> read_effects();

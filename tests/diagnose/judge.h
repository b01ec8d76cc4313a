// Small scenes (quads, spheres, one material each), their pictures as numbers (the means of their
// tiles), what mistakes make of these, and what is wrong with pictures that any renderer made.
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

/// What a folder holds.
struct Folder {
    std::map<std::string, Tiles> scenes;  // the means of the tiles, with their standard errors
    std::vector<std::string> missing;     // scenes without a picture
    std::vector<std::string> notes;       // "NAME.pfm: error: ..."
};

/// Reads NAME.pfm of each scene, and NAME.2.pfm, a render with another seed. The error of a tile:
/// from the differences of its pixels.
Folder read_folder(const std::string& folder);

/// What is said of the pictures, line by line.
struct Diagnosis {
    std::string text;
    std::string name;  // the mistake or the two that explain all; else ""
    int off = 0, noisy = 0;
};

/// A tile is off if its distance from what it should be would happen by chance in one of a thousand
/// such sets of pictures, and is 0.8 % at least. A mistake is named only if it explains all
/// numbers, a thousand times better than every other known one, and predicts something of each
/// scene that is off; else two that do.
/// tested by  "truth: the mistake in another renderer's pictures is named"
Diagnosis judge(const Folder& folder, const std::vector<Hypothesis>& effects);

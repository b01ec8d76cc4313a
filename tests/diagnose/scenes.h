// The known scenes that any path tracer can render: quads, spheres, and one material each.
#pragma once
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

// The known scenes that any path tracer can render: quads, spheres, and one material each.
#pragma once
#include "tests/known/scenes.h"

/// Numbers of one scene: of its 4 x 4 tiles, row by row; of a coloured scene first those of red.
using Tiles = std::vector<Quantity>;

struct SmallScene {
    std::string name;        // of its files
    std::string what;        // is seen there, in a few words
    std::string pbrt = {};   // the scene, with one object on each line
    std::string words = {};  // the same in words and numbers, in Markdown
    Tiles should = {};       // what its tiles should be
    int width = 16;          // pixels
    size_t lights = 1;
    bool has_sky = false;
    bool coloured = false;  // its channels differ
};

/// Those of tests/known/tiles.tsv.
const std::vector<SmallScene>& small_scenes();
/// The page that states them all.
std::string small_scenes_page();

// From pictures of the small scenes that any renderer made, to what is wrong with it.
#pragma once
#include "tests/diagnose/tiles.h"

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

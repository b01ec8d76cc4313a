// The small scenes that any path tracer can render: quads, spheres, and one material each.
#pragma once
#include <set>
#include <string>
#include <vector>

struct SmallScene {
    std::string name;                // of its files
    std::string what;                // is seen there, in a few words
    std::string pbrt;                // the scene, with one object on each line
    std::string words;               // the same in words and numbers, in Markdown
    std::set<std::string> has = {};  // "a sky", "more than one light"
    bool coloured = false;           // its channels differ
    int depth = 1;                   // the most times that a path scatters
};

/// All of them: most of the probes of make check, and some more.
std::vector<SmallScene> small_scenes();
/// The page that states them all.
std::string small_scenes_page();

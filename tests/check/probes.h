// Small scenes in which one thing at a time is other than usual: what they show of a mistake tells
// which it is.
#pragma once
#include <string>
#include <vector>

struct Probe {
    std::string name;
    std::string what;                          // is seen there, in a few words
    std::string text;                          // a pbrt scene
    int first_chapter = 7, last_chapter = 21;  // that can render it
    int samples = 64;                          // a pixel, of 16 x 16, in all
};

/// All of them. In most a floor of albedo 1/2 is seen from above, lit by a black lamp of 1 x 1.
std::vector<Probe> all_probes();

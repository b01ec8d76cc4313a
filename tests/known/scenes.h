// Small scenes whose light is known, in total and by class of path. In each, one thing is other
// than usual: what is off there tells which mistake it is. For tests, make check and
// build/diagnose.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

/// A mean, and its standard error: 0 for a closed form.
struct Quantity {
    double mean = 0, se = 0;
};

struct KnownScene {
    std::string name;
    std::string what;                            // is seen there, in a few words
    std::string text;                            // a pbrt scene
    int first_chapter = 7, last_chapter = 21;    // that can render it
    int samples = 64;                            // a pixel, of 16 x 16, in all
    std::map<std::string, Quantity> light = {};  // mean of the picture: "all", and by class, "LDE"
    std::string source = {};                     // of these numbers
};

/// All of them. In most a floor of albedo 1/2 is seen from above, lit by a black lamp of 1 x 1.
const std::vector<KnownScene>& known_scenes();
const KnownScene& known_scene(const std::string& name);

/// A small random scene, in pbrt's format, of what a chapter can render: several lights, shapes and
/// materials at once, as no list has them. The same for the same number, on every machine.
std::string random_world(int chapter, uint32_t number);

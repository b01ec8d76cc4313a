// What one path adds to the picture.
#pragma once
#include <cstdint>
#include <string>

#include "common/base/vec.h"

/// Part of a sample: the class of its path in Heckbert's notation, from light to eye, and how much.
/// S: a vertex with one possible direction (mirror, glass); D: any other.
struct Contribution {
    static constexpr size_t own_pixel = SIZE_MAX;

    std::string path_class;    // such as "LDSE"
    Rgb L;                     // weighted, W m^-2 sr^-1
    size_t pixel = own_pixel;  // or the one in which the camera sees a path from a light
    int vertex = 0;            // number of the last one on the way; 0: none
    std::string way = {};      // how the light was found
    float mis = 1;
};

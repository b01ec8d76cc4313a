// One parameter of a pbrt-v4 scene file: `"float fov" 45` or `"point3 P" [0 0 0  1 0 0  0 1 0]`.
#pragma once
#include <string>
#include <vector>

#include "common/scene_file/lexer.h"

struct Param {
    std::string type, name;
    Position at;
    std::vector<double> numbers;  // also of integers, points and colors
    std::vector<std::string> strings;
    std::vector<bool> bools;
    bool used = false;
};

/// Reads a declaration and its value or values, and checks that they fit the type.
Param read_param(Lexer& lexer);

// The files that a scene file names.
#pragma once
#include <string>

#include "common/position.h"

struct NamedFile {
    std::string path, bytes;
};

/// Reads the file that is named at a place in a scene file: relative to the file that names it, or,
/// where there is none, to the main scene file, which is what pbrt does.
/// Throws InputError at that place when it cannot be read.
NamedFile read_named_file(const std::string& main_file, const Position& at,
                          const std::string& name);

// The files that a scene file names.
#pragma once
#include <string>

#include "common/base/position.h"

/// The path of the file that is named at a place in a scene file: relative to the file that names
/// it, or, where there is no such file, to the main scene file, which is what pbrt does.
std::string find_named_file(const std::string& main_file, const Position& at,
                            const std::string& name);

/// The bytes of the file; throws InputError at the place that names it when it cannot be read.
std::string read_named_file(const std::string& path, const Position& at);

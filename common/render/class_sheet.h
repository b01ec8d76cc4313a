// --split: all classes of paths as one sheet.
#pragma once
#include <map>
#include <string>

#include "common/picture/film.h"

/// A tile for each class, brightest first, with its name and its share of the light. A dark class
/// is shown 2, 4, ... up to 64 times as bright, and its tile says so.
Image class_sheet(const std::map<std::string, Film>& classes);

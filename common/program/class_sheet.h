// --split: all classes of paths as one sheet.
#pragma once
#include <map>
#include <string>

#include "common/picture/film.h"

/// A tile for each class, those of most light first, with its name and its share of the light.
/// A class that is dark throughout is shown 2, 4, ... up to 64 times as bright, which its tile
/// says.
Image class_sheet(const std::map<std::string, Film>& classes);

// Reads a scene from a file in our subset of pbrt-v4's scene language.
#pragma once
#include <string>
#include <vector>

#include "common/base/report.h"
#include "common/scene/scene.h"
#include "common/scene_file/limits.h"

/// Reads the scene file and all that it includes. Everything is in world space afterwards, powers
/// are radiances, and metals have eta and k; the BVH is left to be built.
///
/// notes   gets a line `file:line:column: note: text` for each thing that is not done as the file
///         says, also when an error follows; may be null
/// stand_ins  whether what is not modelled is replaced (see stand_ins.h)
/// report  hears which file is read, and how far it is
/// errors  InputError with a line `file:line:column: error: text` for each thing that is wrong or
///         not supported, at the first place where it is (after 20 lines the rest is not read)
/// source  pbrt.org/fileformat-v4, and pbrt-v4 itself      tested by  tests/common/reader.cpp
Scene load_scene(const std::string& path, std::vector<std::string>* notes,
                 const Report& report = {}, bool stand_ins = false);

/// Reads a scene file that is already in memory, as load_scene does; `path` says where it belongs.
Scene parse_scene(const std::string& path, std::string text, std::vector<std::string>* notes,
                  const Report& report = {}, const Limits& limits = {}, bool stand_ins = false);

// Reads a scene from a file in our subset of pbrt-v4's scene language.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "common/base/parallel.h"
#include "common/scene/scene.h"

/// How large a scene may be. What grows beyond it is refused where it does, before it fills the
/// memory. A scene at the limit is read in minutes, and takes some 10 GB while its hierarchy is
/// built.
struct Limits {
    uint64_t directives = 10'000'000;
    uint64_t primitives = uint64_t{1} << 25;
    uint64_t vertices = uint64_t{1} << 26;
};

/// Reads the scene file and all that it includes. Everything is in world space afterwards, powers
/// are radiances, and metals have eta and k; the BVH is left to be built.
///
/// notes   gets a line `file:line:column: note: text` for each thing that is not done as the file
///         says, also when an error follows; may be null
/// stand_ins  whether what is not modelled is replaced (see supported.cpp)
/// report  hears which file is read, and how far it is
/// errors  InputError with a line `file:line:column: error: text` for each thing that is wrong or
///         not supported, at the first place where it is (after 20 lines the rest is not read)
/// source  pbrt.org/fileformat-v4, and pbrt-v4 itself      tested by  tests/common/reader.cpp
Scene load_scene(const std::string& path, std::vector<std::string>* notes,
                 const Report& report = {}, bool stand_ins = false);

/// Reads a scene file that is already in memory, as load_scene does; `path` says where it belongs.
Scene parse_scene(const std::string& path, std::string text, std::vector<std::string>* notes,
                  const Report& report = {}, const Limits& limits = {}, bool stand_ins = false);

/// What --stand-in renders in the place of what the programs do not model, by its name; see
/// supported.cpp. scenes/README.md sums them up.
const std::map<std::string, std::string>& all_stand_ins();
/// "; --stand-in renders it as INSTEAD", which ends a message; empty for what has no stand-in.
std::string or_stand_in(const std::string& what);

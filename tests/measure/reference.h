// Pictures so exact that the charts can take them for the truth: one of each scene.
#pragma once
#include <map>
#include <sstream>
#include <string>

#include "common/base/files.h"

/// How a scene's picture was made, and the error that is expected of it.
struct Reference {
    std::string method;
    int spp = 0, max_depth = 0;
    double rmse = 0;
};

inline const std::string reference_folder = "tests/measure/references/";
inline const std::string reference_table = reference_folder + "table.tsv";

/// The table of all references, by file_name(scene_name) of the scene: the picture's name.
inline std::map<std::string, Reference> read_references() {
    std::map<std::string, Reference> all;
    std::istringstream lines(read_file(reference_table));
    std::string line, scene;
    std::getline(lines, line);  // the names of the columns
    while (std::getline(lines, line)) {
        std::istringstream cells(line);
        Reference r;
        cells >> scene >> r.method >> r.spp >> r.max_depth >> r.rmse;
        all[scene] = r;
    }
    return all;
}

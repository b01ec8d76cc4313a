#include "common/options/project.h"

#include <filesystem>

#include "common/base/system.h"

namespace fs = std::filesystem;

std::string project_file(const std::string& program, const std::string& name) {
    std::error_code none;
    fs::path folder = own_file(program), above = folder.parent_path();
    while (above != folder) {
        folder = above, above = folder.parent_path();
        if (!fs::exists(folder / file_path(name), none)) continue;
        fs::path near = (folder / file_path(name)).lexically_proximate(fs::current_path(none));
        return file_name(near);
    }
    return name;
}

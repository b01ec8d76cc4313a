#include "common/program/project.h"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <sstream>

namespace fs = std::filesystem;

/// The program's file, with links resolved; empty if it is not known.
static fs::path program_file(const std::string& program) {
    std::error_code none;
    if (program.find('/') != std::string::npos) return fs::canonical(program, none);
    const char* path = std::getenv("PATH");
    std::istringstream folders(path != nullptr ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');) {
        fs::path file = fs::path(folder.empty() ? "." : folder) / program;
        bool runs = ::access(file.c_str(), X_OK) == 0 && fs::is_regular_file(file, none);
        if (runs) return fs::canonical(file, none);
    }
    return {};
}

std::string project_file(const std::string& program, const std::string& name) {
    std::error_code none;
    fs::path folder = program_file(program), above = folder.parent_path();
    while (above != folder) {
        folder = above, above = folder.parent_path();
        if (!fs::exists(folder / name, none)) continue;
        fs::path near = (folder / name).lexically_proximate(fs::current_path(none));
        return near.string();
    }
    return name;
}

#include "tests/support/folder.h"

#include <random>

TemporaryFolder::TemporaryFolder() {
    std::random_device random;
    auto name = "path-" + std::to_string(random()) + std::to_string(random());
    std::filesystem::path path = std::filesystem::temp_directory_path() / name;
    if (!std::filesystem::create_directory(path)) throw std::runtime_error("no folder");
    path_ = file_name(path);
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code none;
    std::filesystem::remove_all(path_, none);
}

std::string TemporaryFolder::operator/(const std::string& name) const { return path_ + "/" + name; }

std::set<std::string> TemporaryFolder::names() const {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(path_)) {
        names.insert(file_name(entry.path().filename()));
    }
    return names;
}

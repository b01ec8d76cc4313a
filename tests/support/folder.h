// Helpers of the tests that write files: a folder that goes away, files of the system, and the text
// of an error.
#pragma once
#include <doctest/doctest.h>
#include <unistd.h>

#include <filesystem>
#include <random>
#include <set>
#include <string>

#include "common/base/error.h"
#include "common/base/system.h"

/// A new folder, removed with all that is in it.
class TemporaryFolder {
public:
    TemporaryFolder() {
        std::random_device random;
        auto name = "path-" + std::to_string(random()) + std::to_string(random());
        std::filesystem::path path = std::filesystem::temp_directory_path() / name;
        if (!std::filesystem::create_directory(path)) throw std::runtime_error("no folder");
        path_ = file_name(path);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    ~TemporaryFolder() {
        std::error_code none;
        std::filesystem::remove_all(path_, none);
    }
    const std::string& path() const { return path_; }
    std::string operator/(const std::string& name) const { return path_ + "/" + name; }

    /// The names of all that is in it.
    std::set<std::string> names() const {
        std::set<std::string> names;
        for (const auto& entry : std::filesystem::directory_iterator(path_))
            names.insert(file_name(entry.path().filename()));
        return names;
    }

private:
    std::string path_;
};

/// Whether the system has this file, such as /dev/full; says so when the test must do without.
inline bool exists_here(const char* path) {
#ifdef _WIN32
    bool exists = false;  // though an emulator may show what is outside
#else
    bool exists = ::access(path, F_OK) == 0;
#endif
    if (!exists) MESSAGE("skipped: there is no " << std::string(path) << " here");
    return exists;
}

/// The device that takes everything.
#ifdef _WIN32
inline const std::string null_device = "NUL";
#else
inline const std::string null_device = "/dev/null";
#endif

/// Makes a symbolic link; says so when the test must do without, as on Windows.
inline bool make_link(const std::string& target, const std::string& link) {
    std::error_code error;
    std::filesystem::create_symlink(target, link, error);
    if (error) MESSAGE("skipped: no symbolic links here");
    return !error;
}

/// The text of the InputError or UsageError that `work` throws; empty when it does not.
template <typename Work>
std::string error_of(const Work& work) {
    try {
        work();
    } catch (const InputError& e) {
        return e.what();
    } catch (const UsageError& e) {
        return e.what();
    }
    return "";
}

// Helpers of the tests that write files: a folder that goes away, files of the system, and the text
// of an error.
#pragma once
#include <doctest/doctest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <set>
#include <string>

#include "common/base/error.h"

/// A new folder, removed with all that is in it.
class TemporaryFolder {
public:
    TemporaryFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "path-XXXXXX").string();
        path_ = ::mkdtemp(name.data()) ? name : throw std::runtime_error("mkdtemp");
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
        for (const auto& entry : std::filesystem::directory_iterator(path_)) {
            names.insert(entry.path().filename().string());
        }
        return names;
    }

private:
    std::string path_;
};

/// Whether the system has this file, such as /dev/full; says so when the test must do without.
inline bool exists_here(const char* path) {
    bool exists = ::access(path, F_OK) == 0;
    if (!exists) MESSAGE("skipped: there is no " << path << " here");
    return exists;
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

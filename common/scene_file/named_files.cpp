#include "common/scene_file/named_files.h"

#include <filesystem>

#include "common/base/files.h"

namespace fs = std::filesystem;

std::string find_named_file(const std::string& main_file, const Position& at,
                            const std::string& name) {
    fs::path path = fs::path(at.file).parent_path() / name;
    fs::path from_main = fs::path(main_file).parent_path() / name;
    std::error_code none;
    bool only_there = !fs::exists(path, none) && fs::exists(from_main, none);
    return (only_there ? from_main : path).string();
}

std::string read_named_file(const std::string& path, const Position& at) {
    try {
        return read_file(path);
    } catch (const InputError& error) {
        // Name the place that asks for the file, before what is wrong with it.
        std::string text = error.what();
        fail(at, quote(path) + ": " + text.substr(text.find(": error: ") + 9));
    }
}

#include "common/pbrt_files.h"

#include <filesystem>

#include "common/files.h"

NamedFile read_named_file(const std::string& main_file, const Position& at,
                          const std::string& name) {
    std::filesystem::path path = std::filesystem::path(at.file).parent_path() / name;
    std::filesystem::path from_main = std::filesystem::path(main_file).parent_path() / name;
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored) && std::filesystem::exists(from_main, ignored)) {
        path = from_main;
    }
    try {
        return {path.string(), read_file(path.string())};
    } catch (const InputError& error) {
        // Name the place that asks for the file, before what is wrong with it.
        std::string text = error.what();
        fail(at, quote(name) + ": " + text.substr(text.find(": error: ") + 9));
    }
}

#include "common/scene_file/files.h"

#include <filesystem>

#include "common/base/files.h"
#include "common/base/system.h"
#include "common/picture/image.h"
#include "common/scene_file/messages.h"

namespace fs = std::filesystem;

std::string read_scene_file(const std::string& path) {
    std::error_code none;
    fs::file_status status = fs::status(file_path(path), none);
    if (fs::is_other(status)) fail({path}, "cannot read: a device or a pipe and no file");
    std::string bytes = read_file(path);
    return is_gzip(bytes) ? unpack_gzip(path, bytes) : bytes;
}

std::string canonical(const std::string& path) {
    std::error_code none;
    return file_name(fs::weakly_canonical(file_path(path), none));
}

std::string NamedFiles::find(const Position& at, const std::string& name) const {
    fs::path path = file_path(at.file).parent_path() / file_path(name);
    fs::path from_main = file_path(main_file_).parent_path() / file_path(name);
    std::error_code none;
    bool only_there = !fs::exists(path, none) && fs::exists(from_main, none);
    return file_name(only_there ? from_main : path);
}

std::string NamedFiles::read(const std::string& path, const Position& at) {
    std::string bytes;
    try {
        bytes = read_scene_file(path);
    } catch (const InputError& error) {
        // Name the place that asks for the file, before what is wrong with it.
        std::string text = error.what();
        fail(at, quote_file(path) + text.substr(text.rfind(": error: ") + 7));
    }
    files_read_.insert(path);
    bytes_read_ += bytes.size();
    add_to_checksum(bytes);
    check_limit(at, bytes_read_, limits_.file_bytes, "bytes in all files together");
    return bytes;
}

void NamedFiles::add_to_checksum(const std::string& bytes) {
    uint64_t size = bytes.size();
    checksum_.add({reinterpret_cast<const char*>(&size), sizeof size});
    checksum_.add(bytes);
}

const TriangleMesh& NamedFiles::mesh(const std::string& path, const Position& at) {
    std::string file = canonical(path);
    auto known = meshes_.find(file);
    if (known != meshes_.end()) return known->second;
    if (report_) report_("reading " + path, 0);
    return meshes_[file] = parse_ply(path, read(path, at), limits_);
}

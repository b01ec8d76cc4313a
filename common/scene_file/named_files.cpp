#include "common/scene_file/named_files.h"

#include <algorithm>
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

NamedFiles::NamedFiles(std::string main_file, const Limits& limits, const Report& report)
    : main_file_(std::move(main_file)), limits_(limits), report_(report) {}

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
        std::string text = error.what(), why = text.substr(text.rfind(": error: ") + 9);
        auto is_windows = [](char c) { return c == '\\' || (c >= '\b' && c <= '\r'); };
        if (std::any_of(path.begin(), path.end(), is_windows)) why += "; write / between folders";
        fail(at, quote_file(path) + ": " + why);
    }
    files_read_.insert(path);
    bytes_read_ += bytes.size();
    add_to_checksum(bytes);
    if (bytes_read_ > limits_.file_bytes) {
        stop_reading(at, "more than " + std::to_string(limits_.file_bytes) +
                             " bytes are read, from all files together");
    }
    return bytes;
}

void NamedFiles::add_to_checksum(std::string_view bytes) {
    add_number(bytes.size());
    checksum_.add(bytes);
}

void NamedFiles::add_number(uint64_t number) {
    checksum_.add({reinterpret_cast<const char*>(&number), sizeof number});
}

const TriangleMesh& NamedFiles::mesh(const std::string& path, const Position& at) {
    std::string file = canonical(path);
    auto [place, is_new] = meshes_.try_emplace(file);
    Mesh& known = place->second;
    if (is_new) known.number = meshes_.size();
    add_number(known.number);
    if (!known.error.empty()) throw InputError(known.error);
    if (!is_new) return known.mesh;
    if (report_) report_("reading " + path, 0);
    try {
        known.mesh = parse_ply(path, read(path, at), limits_);
        return known.mesh;
    } catch (const InputError& error) {
        known.error = error.what();
        throw;
    }
}

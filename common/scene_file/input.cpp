#include "common/scene_file/input.h"

#include <filesystem>

#include "common/base/files.h"
#include "common/base/system.h"
#include "common/picture/image.h"

namespace fs = std::filesystem;

void stop_reading(const Position& at, const std::string& text) {
    throw ReadingEnds(message_at(at, "error", text));
}

void check_limit(const Position& at, uint64_t count, uint64_t most, const std::string& things) {
    if (count > most) stop_reading(at, "more than " + std::to_string(most) + ' ' + things);
}

void Input::note(const Position& at, const std::string& text) {
    constexpr size_t most = 100;
    if (notes_.size() > most || !texts_.insert(text).second) return;
    bool too_many = notes_.size() == most;
    notes_.push_back(
        message_at(at, "note", too_many ? "there is more of which to take note" : text));
}

void Input::error(const Position& at, const std::string& text) {
    add(InputError(message_at(at, "error", text)));
}

void Input::add(const std::exception& error) {
    std::string line = error.what();
    std::string text = line.substr(std::min(line.size(), line.find(": error: ")));
    if (texts_.insert(text).second) errors_.push_back(line);
}

void Input::stand_in(const Position& at, const std::string& what, const std::string& text) {
    if (stand_ins) {
        used_[what].insert(at);
    } else {
        std::string wrong = text.empty() ? what + " is not supported" : text;
        error(at, wrong + or_stand_in(what).substr(wrong.ends_with('?') ? 1 : 0));
    }
}

bool Input::try_to_read(const Position& at, const std::string& what,
                        const std::function<void()>& read) {
    try {
        read();
        return true;
    } catch (const InputError& error) {
        if (stand_ins) stand_in(at, what);
        if (!stand_ins) add(InputError(error.what() + or_stand_in(what)));
        return false;
    }
}

Origin Input::finish() const {
    throw_lines(errors_);
    Origin origin = {main_file, files_, checksum_.value(), {}};
    for (const auto& [what, instead] : all_stand_ins()) {
        auto found = used_.find(what);
        if (found == used_.end()) continue;
        const std::set<Position>& places = found->second;
        origin.stand_ins.push_back({what, instead, places.size(), *places.begin()});
    }
    return origin;
}

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

std::string Input::find(const Position& at, const std::string& name) const {
    fs::path path = file_path(at.file).parent_path() / file_path(name);
    fs::path from_main = file_path(main_file).parent_path() / file_path(name);
    std::error_code none;
    bool only_there = !fs::exists(path, none) && fs::exists(from_main, none);
    return file_name(only_there ? from_main : path);
}

std::string Input::read(const std::string& path, const Position& at) {
    std::string bytes;
    try {
        bytes = read_scene_file(path);
    } catch (const InputError& error) {
        // Name the place that asks for the file, before what is wrong with it.
        std::string text = error.what();
        fail(at, quote_file(path) + text.substr(text.rfind(": error: ") + 7));
    }
    add_file(path, bytes);
    bytes_read_ += bytes.size();
    check_limit(at, bytes_read_, limits.file_bytes, "bytes in all files together");
    return bytes;
}

const TriangleMesh& Input::mesh(const std::string& path, const Position& at) {
    std::string file = canonical(path);
    auto known = meshes_.find(file);
    if (known != meshes_.end()) return known->second;
    if (report) report("reading " + path, 0);
    return meshes_[file] = parse_ply(path, read(path, at), limits);
}

void Input::add_file(const std::string& path, const std::string& bytes) {
    files_.insert(path);
    uint64_t size = bytes.size();
    checksum_.add({reinterpret_cast<const char*>(&size), sizeof size});
    checksum_.add(bytes);
}

// What the reader of a scene goes through, and what it has to say of it: files; notes, stand-ins,
// and errors of which one run finds many.
#pragma once
#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "common/base/files.h"
#include "common/base/system.h"
#include "common/picture/image.h"
#include "common/scene/origin.h"
#include "common/scene_file/ply.h"

/// An error behind which nothing more is read: a limit that is passed, a string without an end.
struct ReadingEnds : std::runtime_error {
    using std::runtime_error::runtime_error;
};
[[noreturn]] inline void stop_reading(const Position& at, const std::string& text) {
    throw ReadingEnds(message_at(at, "error", text));
}
/// Stops where there are more than `most` things.
inline void check_limit(const Position& at, uint64_t count, uint64_t most,
                        const std::string& things) {
    if (count > most) stop_reading(at, "more than " + std::to_string(most) + ' ' + things);
}

/// The names of what a map has, and what it has under a name; throws `unknown KIND "NAME"` at a
/// place.
template <class Map>
std::vector<std::string> names_of(const Map& map) {
    std::vector<std::string> names;
    for (const auto& [name, value] : map) names.push_back(name);
    return names;
}
template <class Map>
const auto& look_up(const Map& map, const std::string& name, const std::string& kind,
                    const Position& at) {
    auto found = map.find(name);
    if (found == map.end()) fail_unknown(at, kind, name, names_of(map));
    return found->second;
}

/// The bytes of a scene file, unpacked if they are packed by gzip; throws InputError when it cannot
/// be read, and at once for what is no file: a device or a pipe may never end.
inline std::string read_scene_file(const std::string& path) {
    std::error_code none;
    std::filesystem::file_status status = std::filesystem::status(file_path(path), none);
    if (std::filesystem::is_other(status))
        fail({path}, "cannot read: a device or a pipe and no file");
    std::string bytes = read_file(path);
    return is_gzip(bytes) ? unpack_gzip(path, bytes) : bytes;
}
/// The one name of a file that has many, such as a/../b.
inline std::string canonical(const std::string& path) {
    std::error_code none;
    return file_name(std::filesystem::weakly_canonical(file_path(path), none));
}

/// One run of the reader: what it may read, has read, and says.
class Input {
public:
    const std::string main_file;
    const Limits limits;
    const Report report;
    const bool stand_ins;  // whether what is not modelled is replaced

    /// Appends notes to `notes`, which has them even when the reader throws.
    Input(std::string path, const Limits& most, const Report& hears,
          std::vector<std::string>& notes, bool replaces)
        : main_file(std::move(path)),
          limits(most),
          report(hears),
          stand_ins(replaces),
          notes_(notes) {}

    // Each text is said only once: with the first place that it is said of.
    /// At most 100 notes are kept.
    void note(const Position& at, const std::string& text) {
        constexpr size_t most = 100;
        if (notes_.size() > most || !texts_.insert(text).second) return;
        bool too_many = notes_.size() == most;
        notes_.push_back(
            message_at(at, "note", too_many ? "there is more of which to take note" : text));
    }
    void error(const Position& at, const std::string& text) {
        add(InputError(message_at(at, "error", text)));
    }
    /// Adds the line of an InputError or ReadingEnds.
    void add(const std::exception& error) {
        std::string line = error.what();
        std::string text = line.substr(std::min(line.size(), line.find(": error: ")));
        if (texts_.insert(text).second) errors_.push_back(line);
    }
    /// Takes the stand-in of this name; where they are not allowed it is an error, `text` if given.
    void stand_in(const Position& at, const std::string& what, const std::string& text = "") {
        if (stand_ins) {
            used_[what].insert(at);
        } else {
            std::string wrong = text.empty() ? what + " is not supported" : text;
            error(at, wrong + or_stand_in(what).substr(wrong.ends_with('?') ? 1 : 0));
        }
    }
    /// Reads a file. Where that throws an InputError, it is an error, or the stand-in is taken.
    bool try_to_read(const Position& at, const std::string& what,
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
    size_t errors() const { return errors_.size(); }
    /// Throws the errors, if there are some; else says what was read, and what stands in.
    Origin finish() const {
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

    /// The path of the file that is named at a place in a scene file: relative to the file that
    /// names it, or, where there is no such file, to the main scene file, which is what pbrt does.
    std::string find(const Position& at, const std::string& name) const {
        std::filesystem::path path = file_path(at.file).parent_path() / file_path(name);
        std::filesystem::path from_main = file_path(main_file).parent_path() / file_path(name);
        std::error_code none;
        bool only_there =
            !std::filesystem::exists(path, none) && std::filesystem::exists(from_main, none);
        return file_name(only_there ? from_main : path);
    }
    /// The bytes of the file; throws at the place that names it when it cannot be read, or when
    /// more than the limit would be read in all.
    std::string read(const std::string& path, const Position& at) {
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
    /// The mesh in a PLY file, which is read once, however often it is named.
    const TriangleMesh& mesh(const std::string& path, const Position& at) {
        std::string file = canonical(path);
        auto known = meshes_.find(file);
        if (known != meshes_.end()) return known->second;
        if (report) report("reading " + path, 0);
        return meshes_[file] = parse_ply(path, read(path, at), limits);
    }
    /// Keeps which files are read, and a checksum of them in the order in which they are read.
    void add_file(const std::string& path, const std::string& bytes) {
        files_.insert(path);
        uint64_t size = bytes.size();
        checksum_.add({reinterpret_cast<const char*>(&size), sizeof size});
        checksum_.add(bytes);
    }

private:
    std::vector<std::string>& notes_;
    std::vector<std::string> errors_;                 // lines
    std::set<std::string> texts_;                     // of errors and notes
    std::map<std::string, std::set<Position>> used_;  // stand-ins, and where
    std::set<std::string> files_;                     // that were read
    uint64_t bytes_read_ = 0;
    Checksum checksum_;
    std::map<std::string, TriangleMesh> meshes_;  // by the canonical names of their files
};

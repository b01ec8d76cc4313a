// What the reader of a scene goes through, and what it has to say of it: files; notes, stand-ins,
// and errors of which one run finds many.
#pragma once
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "common/base/files.h"
#include "common/base/system.h"
#include "common/picture/image.h"
#include "common/scene/prepare.h"
#include "common/scene_file/lexer.h"
#include "common/scene_file/reader.h"

/// A copy of the position that lasts as long as the program: what a scene is made of points to it.
inline const Position* kept(const Position& at) {
    static std::mutex mutex;
    static std::set<Position> all;
    std::lock_guard lock(mutex);
    return &*all.insert(at).first;
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
    if (found == map.end()) fail(at, unknown(kind, name, names_of(map)));
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
    return unpack_gzip(path, bytes);
}

/// One run of the reader: what it may read, has read, and says.
struct Input {
    const std::string main_file;
    const Limits limits;
    const Report report;
    const bool stand_ins;                  // whether what is not modelled is replaced
    std::vector<std::string>& notes;       // lines, also when the reader throws
    std::vector<std::string> errors = {};  // lines
    std::set<std::string> texts = {};      // of errors and notes
    std::map<std::string, std::set<Position>> used = {};  // stand-ins, and where
    Origin origin = {};                                   // what was read
    Checksum checksum = {};

    /// Each text is said only once, with its first place; at most 100 notes are kept.
    void note(const Position& at, const std::string& text) {
        if (notes.size() == 100 || !texts.insert(text).second) return;
        notes.push_back(message_at(at, "note", text));
    }
    void error(const Position& at, const std::string& text) {
        add(InputError(message_at(at, "error", text)));
    }
    /// Adds the line of an InputError or ReadingEnds.
    void add(const std::exception& error) {
        std::string line = error.what();
        std::string text = line.substr(std::min(line.size(), line.find(": error: ")));
        if (texts.insert(text).second) errors.push_back(line);
    }
    /// Takes the stand-in of this name; where they are not allowed it is an error, `text` if given.
    void stand_in(const Position& at, const std::string& what, const std::string& text = "") {
        if (stand_ins) {
            used[what].insert(at);
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
            if (stand_ins) used[what].insert(at);
            if (!stand_ins) add(InputError(error.what() + or_stand_in(what)));
        }
        return false;
    }
    /// Throws the errors, if there are some; else says what was read, and what stands in.
    Origin finish() {
        throw_lines(errors);
        origin.file = main_file;
        origin.checksum = checksum.value();
        for (const auto& [what, places] : used) {
            std::string instead = all_stand_ins().at(what);
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
        return file_name(std::filesystem::exists(path, none) ? path : from_main);
    }
    /// The bytes of the file; throws at the place that names it when it cannot be read.
    std::string read(const std::string& path, const Position& at) {
        std::string bytes;
        try {
            bytes = read_scene_file(path);
        } catch (const InputError& error) {
            // Name the place that asks for the file, before what is wrong with it.
            std::string text = error.what();
            fail(at, quote(path, 4096) + text.substr(text.rfind(": error: ") + 7));
        }
        add_file(path, bytes);
        return bytes;
    }
    /// Keeps which files are read, and a checksum of them in the order in which they are read.
    void add_file(const std::string& path, const std::string& bytes) {
        if (report) report("reading " + path, 0);
        origin.files.insert(path);
        uint64_t size = bytes.size();
        checksum.add({reinterpret_cast<const char*>(&size), sizeof size});
        checksum.add(bytes);
    }
};

// What the reader of a scene goes through, and what it has to say of it: files; notes, stand-ins,
// and errors of which one run finds many.
#pragma once
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "common/base/checksum.h"
#include "common/scene/origin.h"
#include "common/scene_file/ply.h"

/// An error behind which nothing more is read: a limit that is passed, a string without an end.
struct ReadingEnds : std::runtime_error {
    using std::runtime_error::runtime_error;
};
[[noreturn]] void stop_reading(const Position& at, const std::string& text);
/// Stops where there are more than `most` things.
void check_limit(const Position& at, uint64_t count, uint64_t most, const std::string& things);

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
std::string read_scene_file(const std::string& path);
/// The one name of a file that has many, such as a/../b.
std::string canonical(const std::string& path);

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
    void note(const Position& at, const std::string& text);
    void error(const Position& at, const std::string& text);
    /// Adds the line of an InputError or ReadingEnds.
    void add(const std::exception& error);
    /// Takes the stand-in of this name; where they are not allowed it is an error, `text` if given.
    void stand_in(const Position& at, const std::string& what, const std::string& text = "");
    /// Reads a file. Where that throws an InputError, it is an error, or the stand-in is taken.
    bool try_to_read(const Position& at, const std::string& what,
                     const std::function<void()>& read);
    size_t errors() const { return errors_.size(); }
    /// Throws the errors, if there are some; else says what was read, and what stands in.
    Origin finish() const;

    /// The path of the file that is named at a place in a scene file: relative to the file that
    /// names it, or, where there is no such file, to the main scene file, which is what pbrt does.
    std::string find(const Position& at, const std::string& name) const;
    /// The bytes of the file; throws at the place that names it when it cannot be read, or when
    /// more than the limit would be read in all.
    std::string read(const std::string& path, const Position& at);
    /// The mesh in a PLY file, which is read once, however often it is named.
    const TriangleMesh& mesh(const std::string& path, const Position& at);
    /// Keeps which files are read, and a checksum of them in the order in which they are read.
    void add_file(const std::string& path, const std::string& bytes);

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

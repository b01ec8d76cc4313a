// What the reader of a scene has to say: notes, stand-ins, and errors of which one run finds many.
#pragma once
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "common/scene/origin.h"

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

/// Notes and errors, each text only once: with the first place it is said of.
class Messages {
public:
    /// Appends notes to `notes`, which has them even when the reader throws.
    Messages(std::vector<std::string>& notes, bool stand_ins)
        : notes_(notes), stand_ins_(stand_ins) {}

    /// Whether what is not modelled is replaced.
    bool stand_ins() const { return stand_ins_; }
    /// At most 100 are kept.
    void note(const Position& at, const std::string& text);
    void error(const Position& at, const std::string& text);
    /// Adds the line of an InputError or ReadingEnds.
    void add(const std::exception& error);
    /// Takes the stand-in of this name; where they are not allowed it is an error, `text` if given.
    void stand_in(const Position& at, const std::string& what, const std::string& text = "");
    /// Reads a file. Where that throws an InputError, it is an error, or the stand-in is taken.
    bool try_to_read(const Position& at, const std::string& what,
                     const std::function<void()>& read);

    /// The stand-ins that were taken, in the order of the table.
    std::vector<UsedStandIn> used() const;
    size_t errors() const { return errors_.size(); }
    /// Throws the errors, if there are some.
    void finish() const;

private:
    std::vector<std::string>& notes_;
    const bool stand_ins_;
    std::vector<std::string> errors_;                 // lines
    std::set<std::string> texts_;                     // of errors and notes
    std::map<std::string, std::set<Position>> used_;  // stand-ins, and where
};

// What the reader of a scene has to say: notes, and errors of which one run finds many.
#pragma once
#include <set>
#include <string>
#include <vector>

#include "common/base/position.h"

/// An error behind which nothing more is read: a limit that is passed, a string without an end.
struct ReadingEnds : std::runtime_error {
    using std::runtime_error::runtime_error;
};
[[noreturn]] void stop_reading(const Position& at, const std::string& text);

/// After so many errors the rest is not read, and the last line says so.
inline constexpr size_t most_errors = 20;
inline constexpr const char* too_much_is_wrong = "so much is wrong that the rest is not read";

/// Lines of one kind, each text only once: with the first place it is said of. Of notes at most
/// 100.
class Messages {
public:
    /// Appends to `lines`, which has them even when the reader throws.
    Messages(std::string kind, std::vector<std::string>& lines);

    void add(const Position& at, const std::string& text);
    /// Adds what an InputError says, line by line.
    void add(const InputError& error);

private:
    std::string kind_;
    std::vector<std::string>& lines_;
    std::set<std::string> texts_;
};

/// All lines as one text, one below the other.
std::string join_lines(const std::vector<std::string>& lines);

// What is thrown when the user's input is wrong, and where in a file it stands; main() prints
// what() and exits.
#pragma once
#include <compare>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/base/text.h"

/// Bad input or a file that cannot be read or written: exit code 1.
/// what() is the whole line, "file:line:column: error: text", or "file: error: text"; or several
/// such lines, where one run finds more that is wrong.
struct InputError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A wrong option or option value: exit code 2.
struct UsageError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Throws these lines, each of an InputError, as one; unless there are none.
inline void throw_lines(const std::vector<std::string>& lines) {
    if (!lines.empty()) throw InputError(listed(lines, "\n", "\n"));
}

/// What stands in an exercise where a function is left to the reader. It ends whatever needs the
/// function: make check says that it waits for it.
[[noreturn]] inline void not_written(const std::string& function) {
    throw std::logic_error("`" + function + "` is not written yet");
}

/// A place in a text file; lines and columns count from 1, columns in characters. Line 0: the file
/// as a whole.
struct Position {
    std::string file;
    int line = 0, column = 0;
    std::strong_ordering operator<=>(const Position&) const = default;
};

/// "file:line:column"; for a file as a whole "file".
inline std::string place_text(const Position& at) {
    if (at.line == 0) return at.file;
    return at.file + ':' + std::to_string(at.line) + ':' + std::to_string(at.column);
}

/// "file:line:column: kind: text", the form in which compilers and editors know it; for a file as a
/// whole "file: kind: text".
inline std::string message_at(const Position& at, const std::string& kind,
                              const std::string& text) {
    return printable(place_text(at) + ": " + kind + ": " + text);
}

/// Throws the InputError for something wrong at a place in a file.
[[noreturn]] inline void fail(const Position& at, const std::string& text) {
    throw InputError(message_at(at, "error", text));
}

/// `unknown KIND "word"` with the nearest of the known words, or with all of a few.
inline std::string unknown(const std::string& kind, const std::string& word,
                           const std::vector<std::string>& known) {
    constexpr size_t few = 12;
    std::string text = "unknown " + kind + ' ' + quote(word), nearest = nearest_word(word, known);
    for (const std::string& name : known) {
        if (nearest.empty() && name.starts_with(word) && !word.empty()) nearest = name;
    }
    if (!nearest.empty()) return text + ": did you mean " + quote(nearest) + '?';
    if (known.empty() || known.size() > few) return text;
    return text + " (known: " + listed(known) + ')';
}

#include "common/base/error.h"

#include <mutex>
#include <set>

void throw_lines(const std::vector<std::string>& lines) {
    if (!lines.empty()) throw InputError(listed(lines, "\n", "\n"));
}

void not_written(const std::string& function) {
    throw std::logic_error("`" + function + "` is not written yet");
}

const Position* kept(const Position& at) {
    static std::mutex mutex;
    static std::set<Position> all;
    std::lock_guard lock(mutex);
    return &*all.insert(at).first;
}

std::string place_text(const Position& at) {
    if (at.line == 0) return at.file;
    return at.file + ':' + std::to_string(at.line) + ':' + std::to_string(at.column);
}

std::string message_at(const Position& at, const std::string& kind, const std::string& text) {
    return printable(place_text(at) + ": " + kind + ": " + text);
}

void fail(const Position& at, const std::string& text) {
    throw InputError(message_at(at, "error", text));
}

std::string unknown(const std::string& kind, const std::string& word,
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

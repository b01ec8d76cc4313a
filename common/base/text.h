// Text for people: UTF-8, what can be printed of it, and the word that a mistyped one was meant to
// be.
#pragma once
#include <algorithm>
#include <numeric>
#include <string>
#include <string_view>
#include <vector>

/// The bytes of the UTF-8 character that starts at bytes[i]; 0 when it is not well formed.
inline size_t utf8_length(std::string_view bytes, size_t i) {
    unsigned char first = static_cast<unsigned char>(bytes[i]);
    if (first < 0x80) return 1;
    size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
    if (first < 0xc2 || first > 0xf4 || i + length > bytes.size()) return 0;
    for (size_t j = 1; j < length; j++) {
        if ((bytes[i + j] & 0xc0) != 0x80) return 0;
    }
    // Refuse overlong forms, surrogates, and what lies beyond U+10FFFF.
    unsigned char second = static_cast<unsigned char>(bytes[i + 1]);
    bool refused = (first == 0xe0 && second < 0xa0) || (first == 0xed && second >= 0xa0) ||
                   (first == 0xf0 && second < 0x90) || (first == 0xf4 && second >= 0x90);
    return refused ? 0 : length;
}

/// Whether this well-formed character is a control character (U+0000 to U+001F, U+007F to U+009F),
/// which a terminal may obey instead of printing it.
inline bool utf8_is_control(std::string_view character) {
    return character < " " || (character >= "\x7f" && character < "\xc2\xa0");
}

/// `text` made fit for one line of a terminal: what is no character to print becomes '?'.
inline std::string printable(std::string_view text) {
    std::string line;
    for (size_t i = 0; i < text.size();) {
        size_t length = utf8_length(text, i);
        std::string_view character = text.substr(i, std::max(length, size_t{1}));
        bool plain = length > 0 && !utf8_is_control(character);
        line += plain ? character : "?";
        i += character.size();
    }
    return line;
}

/// A word of the input in quotes, cut off where it is too long to print.
inline std::string quote(std::string_view word, size_t longest = 60) {
    if (word.size() <= longest) return '"' + std::string(word) + '"';
    // Cut before a character, not inside one.
    size_t end = longest;
    while (end > 0 && (word[end] & 0xc0) == 0x80) end--;
    return '"' + std::string(word.substr(0, end)) + "...\"";
}

/// The name of a file in quotes. Only what is too long for one is cut: the end says which it is.
inline std::string quote_file(const std::string& name) { return quote(name, 4096); }

/// How many letters must be inserted, deleted or replaced to turn a into b.
inline size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), size_t{0});
    for (char letter : a) {
        size_t diagonal = row[0]++;
        for (size_t j = 0; j < b.size(); j++) {
            size_t replaced = diagonal + (letter != b[j]);
            diagonal = row[j + 1];
            row[j + 1] = std::min({diagonal + 1, row[j] + 1, replaced});
        }
    }
    return row.back();
}

/// The known word nearest to `word`; empty when none is closer than half its length. Only the first
/// 64 letters of the word and the first 10,000 known words count, since longer searches take
/// seconds.
inline std::string nearest_word(std::string_view word, const std::vector<std::string>& known) {
    constexpr size_t longest = 64, most = 10'000;
    word = word.substr(0, longest);
    std::string nearest;
    size_t best = word.size() / 2 + 1;
    for (size_t i = 0; i < std::min(known.size(), most); i++) {
        const std::string& candidate = known[i];
        if (candidate.size() >= word.size() + best) continue;  // as many letters to insert
        size_t distance = edit_distance(word, candidate);
        if (distance < best) {
            best = distance;
            nearest = candidate;
        }
    }
    return nearest;
}

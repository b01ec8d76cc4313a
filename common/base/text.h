// Text for people and programs: UTF-8, what can be printed of it, and the word that a mistyped one
// was meant to be; numbers from text, the same with every library, and as text; JSON.
#pragma once
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numeric>
#include <optional>
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

/// `text` made fit for one line of a terminal: what is no character to print becomes '?', and so do
/// control characters (U+0000 to U+001F, U+007F to U+009F), which a terminal may obey.
inline std::string printable(std::string_view text) {
    std::string line;
    for (size_t i = 0; i < text.size();) {
        size_t length = utf8_length(text, i);
        std::string_view character = text.substr(i, std::max(length, size_t{1}));
        bool is_control = character < " " || (character >= "\x7f" && character < "\xc2\xa0");
        bool plain = length > 0 && !is_control;
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

/// "a, b and c", where `last` is " and ".
inline std::string listed(const std::vector<std::string>& words, const std::string& last = ", ",
                          const std::string& between = ", ") {
    std::string text;
    for (size_t i = 0; i < words.size(); i++)
        text += (i == 0 ? "" : i + 1 < words.size() ? between : last) + words[i];
    return text;
}

/// The known word nearest to `word`, by the number of letters to insert, delete or replace; empty
/// when none is closer than half its length. Only the first 64 letters of the word count, since
/// longer searches take seconds.
inline std::string nearest_word(std::string_view word, const std::vector<std::string>& known) {
    word = word.substr(0, 64);
    std::string nearest;
    size_t best = word.size() / 2 + 1;
    for (const std::string& candidate : known) {
        if (candidate.size() >= word.size() + best) continue;  // as many letters to insert
        std::vector<size_t> row(candidate.size() + 1);
        std::iota(row.begin(), row.end(), size_t{0});
        for (char letter : word) {
            size_t diagonal = row[0]++;
            for (size_t j = 0; j < candidate.size(); j++) {
                size_t replaced = diagonal + (letter != candidate[j]);
                diagonal = row[j + 1];
                row[j + 1] = std::min({diagonal + 1, row[j] + 1, replaced});
            }
        }
        if (row.back() < best) {
            best = row.back();
            nearest = candidate;
        }
    }
    return nearest;
}

/// Without the + that a number may begin with.
inline std::string_view without_plus(std::string_view text) {
    return text.starts_with('+') && !text.starts_with("+-") ? text.substr(1) : text;
}

/// The number that `text` writes, rounded to the nearest double; no inf, no nan, no hexadecimal;
/// empty when it is none. Numbers too large for a double are infinite, those too small are 0.
///
/// tested by  "truth: numbers are rounded to the nearest double, halves to the even one"
inline std::optional<double> to_number(std::string_view text) {
    text = without_plus(text);
    bool negative = text.starts_with('-');
    std::string_view digits = text.substr(negative ? 1 : 0);
    if (digits.empty() || !(digits[0] == '.' || (digits[0] >= '0' && digits[0] <= '9'))) return {};
#ifdef __cpp_lib_to_chars  // several times as fast, but not every library has it for doubles
    double value = 0;
    auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (stop != text.data() + text.size() || error == std::errc::invalid_argument) return {};
    if (error == std::errc()) return value;
#endif
    if (digits.find_first_not_of("0123456789.eE+-") != std::string_view::npos) return {};
    std::string copy(text);
    char* end = nullptr;
    double rounded = std::strtod(copy.c_str(), &end);
    if (end != copy.c_str() + copy.size()) return {};
    return rounded;
}

/// The whole number that `text` writes, without point or exponent; empty if it does not fit an int.
inline std::optional<int> to_integer(std::string_view text) {
    text = without_plus(text);
    int value = 0;
    auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (end != text.data() + text.size() || error != std::errc()) return {};
    return value;
}

/// What printf would print, up to 999 bytes of it.
template <typename... Args>
std::string format(const char* pattern, Args... args) {
    char text[1000];
    std::snprintf(text, sizeof text, pattern, args...);
    return text;
}

/// A share to three digits: 0.0123 is "1.23 %", 0.99999 is "100 %" and not "1e+02 %", 52 is "5200
/// %".
///
/// tested by  "truth: large shares are written without an exponent"
inline std::string percent(double share) {
    double value = 100 * share;
    return format(std::abs(value) >= 99.95 ? "%.0f %%" : "%.3g %%", value);
}

/// x with `significant` digits; "infinite", or "unknown" if it is not a number.
inline std::string digits(double x, int significant = 5) {
    if (std::isnan(x)) return "unknown";
    if (std::isinf(x)) return x > 0 ? "infinite" : "-infinite";
    return format("%.*g", significant, x);
}

/// A text in JSON's quotes, of what can be printed.
inline std::string json_quoted(std::string_view text) {
    std::string json = "\"";
    for (char c : printable(text)) {
        if (c == '"' || c == '\\') json += '\\';
        json += c;
    }
    return json + '"';
}

/// A number with nine digits; null for what is not finite.
inline std::string json_number(double value) {
    return std::isfinite(value) ? format("%.9g", value) : "null";
}

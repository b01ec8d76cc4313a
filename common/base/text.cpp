#include "common/base/text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <numeric>

size_t utf8_length(std::string_view bytes, size_t i) {
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

std::string printable(std::string_view text) {
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

std::string quote(std::string_view word, size_t longest) {
    if (word.size() <= longest) return '"' + std::string(word) + '"';
    // Cut before a character, not inside one.
    size_t end = longest;
    while (end > 0 && (word[end] & 0xc0) == 0x80) end--;
    return '"' + std::string(word.substr(0, end)) + "...\"";
}

std::string listed(const std::vector<std::string>& words, const std::string& last,
                   const std::string& between) {
    std::string text;
    for (size_t i = 0; i < words.size(); i++)
        text += (i == 0 ? "" : i + 1 < words.size() ? between : last) + words[i];
    return text;
}

std::string nearest_word(std::string_view word, const std::vector<std::string>& known) {
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
static std::string_view without_plus(std::string_view text) {
    return text.starts_with('+') && !text.starts_with("+-") ? text.substr(1) : text;
}

std::optional<double> to_number(std::string_view text) {
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

std::optional<int> to_integer(std::string_view text) {
    text = without_plus(text);
    int value = 0;
    auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (end != text.data() + text.size() || error != std::errc()) return {};
    return value;
}

std::string percent(double share) {
    double value = 100 * share;
    return format(std::abs(value) >= 99.95 ? "%.0f %%" : "%.3g %%", value);
}

std::string digits(double x, int significant) {
    if (std::isnan(x)) return "unknown";
    if (std::isinf(x)) return x > 0 ? "infinite" : "-infinite";
    return format("%.*g", significant, x);
}

std::string json_quoted(std::string_view text) {
    std::string json = "\"";
    for (char c : printable(text)) {
        if (c == '"' || c == '\\') json += '\\';
        json += c;
    }
    return json + '"';
}

std::string json_number(double value) {
    return std::isfinite(value) ? format("%.9g", value) : "null";
}

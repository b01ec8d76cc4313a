// Text for people and programs: UTF-8, what can be printed of it, and the word that a mistyped one
// was meant to be; numbers from text, the same with every library, and as text; JSON.
#pragma once
#include <cstdio>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// The bytes of the UTF-8 character that starts at bytes[i]; 0 when it is not well formed.
size_t utf8_length(std::string_view bytes, size_t i);

/// `text` made fit for one line of a terminal: what is no character to print becomes '?', and so do
/// control characters (U+0000 to U+001F, U+007F to U+009F), which a terminal may obey.
std::string printable(std::string_view text);

/// A word of the input in quotes, cut off where it is too long to print.
std::string quote(std::string_view word, size_t longest = 60);

/// "a, b and c", where `last` is " and ".
std::string listed(const std::vector<std::string>& words, const std::string& last = ", ",
                   const std::string& between = ", ");

/// The known word nearest to `word`, by the number of letters to insert, delete or replace; empty
/// when none is closer than half its length. Only the first 64 letters of the word count, since
/// longer searches take seconds.
std::string nearest_word(std::string_view word, const std::vector<std::string>& known);

/// The number that `text` writes, rounded to the nearest double; no inf, no nan, no hexadecimal;
/// empty when it is none. Numbers too large for a double are infinite, those too small are 0.
///
/// tested by  "truth: numbers are rounded to the nearest double, halves to the even one"
std::optional<double> to_number(std::string_view text);

/// The whole number that `text` writes, without point or exponent; empty if it does not fit an int.
std::optional<int> to_integer(std::string_view text);

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
std::string percent(double share);

/// x with `significant` digits; "infinite", or "unknown" if it is not a number.
std::string digits(double x, int significant = 5);

/// A text in JSON's quotes, of what can be printed.
std::string json_quoted(std::string_view text);

/// A number with nine digits; null for what is not finite.
std::string json_number(double value);

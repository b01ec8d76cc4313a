// Numbers read from text, the same with every library and in every country.
#pragma once
#include <optional>
#include <string_view>

/// The number that `text` writes, rounded to the nearest double; no inf, no nan, no hexadecimal;
/// empty when it is none. Numbers too large for a double are infinite, those too small are 0.
///
/// tested by  "truth: numbers are rounded to the nearest double, halves to the even one"
std::optional<double> to_number(std::string_view text);

/// The whole number that `text` writes, without point or exponent; empty if it does not fit an int.
std::optional<int> to_integer(std::string_view text);

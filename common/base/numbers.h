// Numbers read from text, the same with every library; and shares as percentages.
#pragma once
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <string_view>

/// The number that `text` writes, rounded to the nearest double; no inf, no nan, no hexadecimal;
/// empty when it is none. Numbers too large for a double are infinite, those too small are 0.
///
/// tested by  "truth: numbers are rounded to the nearest double, halves to the even one"
std::optional<double> to_number(std::string_view text);

/// The whole number that `text` writes, without point or exponent; empty if it does not fit an int.
std::optional<int> to_integer(std::string_view text);

/// A share to three digits: 0.0123 is "1.23 %", 0.99999 is "100 %" and not "1e+02 %", 52 is "5200
/// %".
///
/// tested by  "truth: large shares are written without an exponent"
inline std::string percent(double share) {
    char text[400];
    double value = 100 * share;
    std::snprintf(text, sizeof text, std::abs(value) >= 99.95 ? "%.0f %%" : "%.3g %%", value);
    return text;
}

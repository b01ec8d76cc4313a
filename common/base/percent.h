// Shares as percentages.
#pragma once
#include <cmath>
#include <cstdio>
#include <string>

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

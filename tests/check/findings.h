// What a class of path brings, beside what it should.
#pragma once
#include <cmath>
#include <numbers>
#include <string>

#include "tests/known/scenes.h"

inline bool is_class(const std::string& name) { return name[0] == 'L' || name == "longer"; }

/// Measured over expected, with its standard error.
inline Quantity ratio_of(Quantity measured, Quantity expected) {
    double r = measured.mean / expected.mean;
    return {r, std::hypot(measured.se / expected.mean, r * expected.se / expected.mean)};
}

/// Whether it is other than expected: by 5 standard errors, and by the share `least` of it. Where
/// nothing is expected: whether it is there.
inline bool is_off(Quantity measured, Quantity expected, double least = 0.008) {
    if (!(expected.mean > 0)) return !(measured.mean <= std::max(4 * measured.se, 2e-3));
    if (expected.se > 0.015 * expected.mean) return false;  // too rare to say
    Quantity r = ratio_of(measured, expected);
    return !(std::abs(r.mean - 1) <= std::max(5 * r.se, least));
}

/// "1/pi" for 0.318: the nearest factor that mistakes are known to make, or "".
inline std::string name_factor(Quantity q) {
    double ratio = q.mean;
    if (q.se > 0.01 * std::abs(ratio)) return "";
    constexpr double pi_exact = std::numbers::pi;
    static const std::pair<double, std::string> factors[] = {
        {pi_exact, "pi"}, {2 * pi_exact, "2 pi"}, {4 * pi_exact, "4 pi"}, {2, "2"}, {3, "3"},
        {4, "4"},         {2.25, "eta^2"}};
    auto is = [&](double factor) { return std::abs(std::log(ratio / factor)) < 0.04; };
    for (const auto& [factor, name] : factors) {
        if (is(factor)) return name;
        bool brackets = name.find(' ') != std::string::npos;
        if (is(1 / factor)) return "1/" + (brackets ? "(" + name + ")" : name);
    }
    return "";
}

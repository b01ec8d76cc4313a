// The state of a solution, and where the light went.
#pragma once
#include "chapters/26_radiosity/patches.h"

namespace ch26 {

/// W m^-2 in red, green and blue. In double: a thousand sweeps must not lose energy.
struct Radiosity {
    double r = 0, g = 0, b = 0;

    Radiosity() = default;
    Radiosity(double red, double green, double blue) : r(red), g(green), b(blue) {}
    Radiosity(Rgb x) : r(double{x.r}), g(double{x.g}), b(double{x.b}) {}
};
inline Radiosity operator+(Radiosity x, Radiosity y) { return {x.r + y.r, x.g + y.g, x.b + y.b}; }
inline Radiosity operator-(Radiosity x, Radiosity y) { return {x.r - y.r, x.g - y.g, x.b - y.b}; }
inline Radiosity operator*(Radiosity x, Radiosity y) { return {x.r * y.r, x.g * y.g, x.b * y.b}; }
inline Radiosity operator*(double s, Radiosity x) { return {s * x.r, s * x.g, s * x.b}; }
inline Radiosity& operator+=(Radiosity& x, Radiosity y) { return x = x + y; }
/// x / y; 0 where y is 0.
inline Radiosity ratio(Radiosity x, Radiosity y) {
    return {y.r > 0 ? x.r / y.r : 0, y.g > 0 ? x.g / y.g : 0, y.b > 0 ? x.b / y.b : 0};
}
inline Radiosity min(Radiosity x, Radiosity y) {
    return {std::min(x.r, y.r), std::min(x.g, y.g), std::min(x.b, y.b)};
}
inline double sum_of(Radiosity x) { return x.r + x.g + x.b; }
inline double largest_of(Radiosity x) {
    return std::max({std::abs(x.r), std::abs(x.g), std::abs(x.b)});
}
inline Rgb to_rgb(Radiosity x) {
    return {static_cast<float>(x.r), static_cast<float>(x.g), static_cast<float>(x.b)};
}

/// What each patch has received so far.
struct Solution {
    std::vector<Radiosity> H;       // W m^-2
    std::vector<Radiosity> unshot;  // W m^-2, of B: not yet sent on; progressive refinement alone
    uint64_t steps = 0;             // sweeps, or shots
    Radiosity escaped;              // W, out of the room
};

/// Where the power of the lamps went, W: emitted = absorbed + escaped + unshot.
/// tested by  "identity: all that lamps emit is absorbed, escapes, or is unshot"
struct Balance {
    double emitted = 0, absorbed = 0, escaped = 0, unshot = 0;
    double error() const { return (absorbed + escaped + unshot) / emitted - 1; }
};
inline Balance balance_of(const std::vector<Patch>& patch, const Solution& s) {
    Balance b;
    for (size_t i = 0; i < patch.size(); i++) {
        double A = double{patch[i].area};
        b.emitted += A * sum_of(patch[i].E);
        b.absorbed += A * sum_of(s.H[i] - patch[i].rho * s.H[i]);
        if (!s.unshot.empty()) b.unshot += A * sum_of(s.unshot[i]);
    }
    b.escaped = sum_of(s.escaped);
    return b;
}

}  // namespace ch26

// Light, metals and glass whose spectra are known.
#pragma once
#include <map>
#include <string>

#include "common/base/vec.h"
#include "common/material/spectrum.h"

/// The color of a black body of 500 to 1e6 K, as linear sRGB with luminance 1: the spectrum
///
///   B(lambda) = 1 / (lambda^5 (exp(c2 / (lambda T)) - 1)),  weighted with the CIE 1931 observer
///
/// What lies outside of sRGB (below about 1900 K) is cut off at 0.  source  Planck 1901; CIE 015
inline Rgb blackbody_rgb(double kelvin) {
    constexpr double c2 = 1.438776877e-2;  // m K, the second radiation constant

    // Weigh the spectrum with the observer, relative to its value at 560 nm against underflow.
    double X = 0, Y = 0, Z = 0, nm = observer_first_nm;
    for (const auto& [x, y, z] : observer) {
        double exponent = c2 / (nm * 1e-9 * kelvin), reference = c2 / (560e-9 * kelvin);
        double B = std::pow(560 / nm, 5) * std::exp(reference - exponent) * std::expm1(-reference) /
                   std::expm1(-exponent);
        X += B * x;
        Y += B * y;
        Z += B * z;
        nm += observer_step_nm;
    }

    // Give the color luminance 1.
    std::array<double, 3> rgb = srgb_from_xyz(X / Y, 1, Z / Y);
    double scale = 1 / (0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]);
    return {static_cast<float>(scale * rgb[0]), static_cast<float>(scale * rgb[1]),
            static_cast<float>(scale * rgb[2])};
}

/// "metal-Ag-eta" and "metal-Ag-k", the complex index of refraction eta + i k, and those of Al, Au
/// and Cu.
///
/// source  measured spectra (Palik 1985), averaged over the sRGB primaries' color matching curves
inline const std::map<std::string, Rgb>& metals() {
    static const std::map<std::string, Rgb> colors = {
        {"metal-Ag-eta", {0.155265f, 0.116723f, 0.138381f}},
        {"metal-Ag-k", {4.828343f, 3.122246f, 2.146950f}},
        {"metal-Al-eta", {1.657460f, 0.880369f, 0.521229f}},
        {"metal-Al-k", {9.223869f, 6.269523f, 4.837001f}},
        {"metal-Au-eta", {0.143119f, 0.374957f, 1.442479f}},
        {"metal-Au-k", {3.983160f, 2.385721f, 1.603215f}},
        {"metal-Cu-eta", {0.200438f, 0.924033f, 1.102212f}},
        {"metal-Cu-k", {3.912949f, 2.452848f, 2.142188f}}};
    return colors;
}

/// pbrt's measured glasses, such as "glass-BK7".
///
/// F5, F10 and F11 are Schott's SF5, N-SF10 and N-SF11.      source  Schott's data sheets
inline const std::map<std::string, Glass>& glasses() {
    static const std::map<std::string, Glass> all = {
        {"glass-BAF10",
         {{1.5851495, 0.143559385, 1.08521269}, {0.00926681282, 0.0424489805, 105.613573}}},
        {"glass-BK7",
         {{1.03961212, 0.231792344, 1.01046945}, {0.00600069867, 0.0200179144, 103.560653}}},
        {"glass-F10",
         {{1.62153902, 0.256287842, 1.64447552}, {0.0122241457, 0.0595736775, 147.468793}}},
        {"glass-F11",
         {{1.73759695, 0.313747346, 1.89878101}, {0.013188707, 0.0623068142, 155.23629}}},
        {"glass-F5",
         {{1.52481889, 0.187085527, 1.42729015}, {0.011254756, 0.0588995392, 129.141675}}},
        {"glass-FK51A",
         {{0.971247817, 0.216901417, 0.904651666}, {0.00472301995, 0.0153575612, 168.68133}}},
        {"glass-LASF9",
         {{2.00029547, 0.298926886, 1.80691843}, {0.0121426017, 0.0538736236, 156.530829}}}};
    return all;
}

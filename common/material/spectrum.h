// What depends on the wavelength: how glass refracts, what colour the standard observer sees; and
// light, metals and glass whose spectra are known.
#pragma once
#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <vector>

#include "common/base/vec.h"

/// A glass: the coefficients fitted to measurements of its index of refraction.
struct Glass {
    double B[3], C[3];  // C in micrometres^2
};

/// The index of refraction at a wavelength in micrometres.
///
///   n^2 = 1 + sum over i of  B_i lambda^2 / (lambda^2 - C_i)
///
/// source  Sellmeier 1871
/// tested by  "truth: the glasses have the indices and Abbe numbers of their data sheets"
inline float index_of_refraction(const Glass& glass, double micrometres) {
    double l2 = micrometres * micrometres, n2 = 1;
    for (int i = 0; i < 3; i++) n2 += glass.B[i] * l2 / (l2 - glass.C[i]);
    return static_cast<float>(std::sqrt(n2));
}

/// The CIE 1931 2-degree observer: x, y, z from 380 nm on, every 10 nm.      source  CIE 015
inline constexpr double observer_first_nm = 380, observer_step_nm = 10;
inline constexpr std::array<std::array<double, 3>, 41> observer = {{
    {0.001368, 0.000039, 0.006450}, {0.004243, 0.000120, 0.020050}, {0.014310, 0.000396, 0.067850},
    {0.043510, 0.001210, 0.207400}, {0.134380, 0.004000, 0.645600}, {0.283900, 0.011600, 1.385600},
    {0.348280, 0.023000, 1.747060}, {0.336200, 0.038000, 1.772110}, {0.290800, 0.060000, 1.669200},
    {0.195360, 0.090980, 1.287640}, {0.095640, 0.139020, 0.812950}, {0.032010, 0.208020, 0.465180},
    {0.004900, 0.323000, 0.272000}, {0.009300, 0.503000, 0.158200}, {0.063270, 0.710000, 0.078250},
    {0.165500, 0.862000, 0.042160}, {0.290400, 0.954000, 0.020300}, {0.433450, 0.994950, 0.008750},
    {0.594500, 0.995000, 0.003900}, {0.762100, 0.952000, 0.002100}, {0.916300, 0.870000, 0.001650},
    {1.026300, 0.757000, 0.001100}, {1.062200, 0.631000, 0.000800}, {1.002600, 0.503000, 0.000340},
    {0.854450, 0.381000, 0.000190}, {0.642400, 0.265000, 0.000050}, {0.447900, 0.175000, 0.000020},
    {0.283500, 0.107000, 0.000000}, {0.164900, 0.061000, 0.000000}, {0.087400, 0.032000, 0.000000},
    {0.046770, 0.017000, 0.000000}, {0.022700, 0.008210, 0.000000}, {0.011359, 0.004102, 0.000000},
    {0.005790, 0.002091, 0.000000}, {0.002899, 0.001047, 0.000000}, {0.001440, 0.000520, 0.000000},
    {0.000690, 0.000249, 0.000000}, {0.000332, 0.000120, 0.000000}, {0.000166, 0.000060, 0.000000},
    {0.000083, 0.000030, 0.000000}, {0.000042, 0.000015, 0.000000},
}};

/// CIE XYZ as linear sRGB; negative channels are set to 0.      source  IEC 61966-2-1
inline Rgbd srgb_from_xyz(double X, double Y, double Z) {
    return {std::max(0.0, 3.2406 * X - 1.5372 * Y - 0.4986 * Z),
            std::max(0.0, -0.9689 * X + 1.8758 * Y + 0.0415 * Z),
            std::max(0.0, 0.0557 * X - 0.2040 * Y + 1.0570 * Z)};
}

/// The contribution of each row of the observer (10 nm) to white light, in linear sRGB. Each
/// channel sums to 1 over all rows.
inline std::vector<Rgb> shares_of_white() {
    std::vector<Rgb> shares;
    Rgb sum;
    for (auto [x, y, z] : observer) {
        shares.push_back(to_rgb(srgb_from_xyz(x, y, z)));
        sum += shares.back();
    }
    for (Rgb& share : shares) share = {share.r / sum.r, share.g / sum.g, share.b / sum.b};
    return shares;
}

/// The color of a black body of 500 to 1e6 K, as linear sRGB with luminance 1: the spectrum
///
///   B(lambda) = 1 / (lambda^5 (exp(c2 / (lambda T)) - 1)),  weighted with the CIE 1931 observer
///
/// What lies outside of sRGB (below about 1900 K) is cut off at 0.  source  Planck 1901; CIE 015
inline Rgb blackbody_rgb(double kelvin) {
    constexpr double c2 = 1.438776877e-2;  // m K, the second radiation constant

    // Weigh the spectrum with the observer, relative to its value at 560 nm against underflow.
    Vec3d sum;
    double nm = observer_first_nm;
    for (const auto& [x, y, z] : observer) {
        double exponent = c2 / (nm * 1e-9 * kelvin), reference = c2 / (560e-9 * kelvin);
        double B = std::pow(560 / nm, 5) * std::exp(reference - exponent) * std::expm1(-reference) /
                   std::expm1(-exponent);
        sum = sum + B * Vec3d{x, y, z};
        nm += observer_step_nm;
    }

    // Give the color luminance 1.
    Rgbd rgb = srgb_from_xyz(sum.x / sum.y, 1, sum.z / sum.y);
    return to_rgb(1 / (0.2126 * rgb.r + 0.7152 * rgb.g + 0.0722 * rgb.b) * rgb);
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

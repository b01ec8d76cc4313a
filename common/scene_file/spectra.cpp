#include "common/scene_file/spectra.h"

#include <array>

#include "common/material/observer.h"

namespace {

double at(const Spectrum& spectrum, double nm) {
    auto after = std::upper_bound(spectrum.begin(), spectrum.end(), nm,
                                  [](double x, const auto& entry) { return x < entry[0]; });
    if (after == spectrum.begin()) return 0;
    auto [nm0, value0] = *(after - 1);
    if (after == spectrum.end()) return nm == nm0 ? value0 : 0;
    auto [nm1, value1] = *after;
    return value0 + (value1 - value0) * (nm - nm0) / (nm1 - nm0);
}

/// X, Y, Z of values at wavelengths in nm.
template <class Values>
std::array<double, 3> xyz_of(const Values& values) {
    constexpr int steps = static_cast<int>(observer_step_nm);  // of 1 nm, in a row
    std::array<double, 3> xyz = {};
    for (int i = 0; i <= steps * (static_cast<int>(observer.size()) - 1); i++) {
        size_t row = static_cast<size_t>(i / steps), next = std::min(row + 1, observer.size() - 1);
        double part = static_cast<double>(i % steps) / steps, value = values(observer_first_nm + i);
        for (size_t k = 0; k < 3; k++) {
            xyz[k] += value * ((1 - part) * observer[row][k] + part * observer[next][k]);
        }
    }
    return xyz;
}

// As linear sRGB; without a light of luminance above 0: black.
Rgb with_luminance_1(const std::array<double, 3>& xyz) {
    if (!(xyz[1] > 0)) return {};
    std::array<double, 3> rgb = srgb_from_xyz(xyz[0] / xyz[1], 1, xyz[2] / xyz[1]);
    double scale = 1 / (0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]);
    return {static_cast<float>(scale * rgb[0]), static_cast<float>(scale * rgb[1]),
            static_cast<float>(scale * rgb[2])};
}

}  // namespace

const Spectrum& standard_daylight() {
    static const Spectrum d65 = [] {
        constexpr std::array<double, observer.size()> values = {
            49.9755, 54.6482, 82.7549, 91.4860, 93.4318, 86.6823, 104.865, 117.008, 117.812,
            114.861, 115.923, 108.811, 109.354, 107.802, 104.790, 107.689, 104.405, 104.046,
            100.000, 96.3342, 95.7880, 88.6856, 90.0062, 89.5991, 87.6987, 83.2886, 83.6992,
            80.0268, 80.2146, 82.2778, 78.2842, 69.7213, 71.6091, 74.3490, 61.6040, 69.8856,
            75.0870, 63.5927, 46.4182, 66.8054, 63.3828};
        Spectrum spectrum;
        double nm = observer_first_nm;
        for (double value : values) {
            spectrum.push_back({nm, value});
            nm += observer_step_nm;
        }
        return spectrum;
    }();
    return d65;
}

Rgb light_rgb(const Spectrum& spectrum) {
    return with_luminance_1(xyz_of([&](double nm) { return at(spectrum, nm); }));
}

Rgb reflectance_rgb(const Spectrum& spectrum) {
    auto light = [](double nm) { return at(standard_daylight(), nm); };
    auto [X, Y, Z] = xyz_of([&](double nm) { return light(nm) * at(spectrum, nm); });
    auto [Xw, Yw, Zw] = xyz_of(light);
    std::array<double, 3> rgb = srgb_from_xyz(X, Y, Z), white = srgb_from_xyz(Xw, Yw, Zw);
    auto channel = [&](size_t i) { return static_cast<float>(std::min(1.0, rgb[i] / white[i])); };
    return {channel(0), channel(1), channel(2)};
}

Rgb mean_rgb(const Spectrum& spectrum) {
    Rgb mean;
    double nm = observer_first_nm;
    for (Rgb share : shares_of_white()) {
        mean += static_cast<float>(at(spectrum, nm)) * share;
        nm += observer_step_nm;
    }
    return mean;
}

const NamedColors& illuminants() {
    auto of = [](double x, double y) { return with_luminance_1({x / y, 1, (1 - x - y) / y}); };
    static const NamedColors colors = {{"stdillum-A", of(0.44758, 0.40745)},
                                       {"stdillum-D50", of(0.34567, 0.35851)},
                                       {"stdillum-D65", of(0.31272, 0.32903)}};
    return colors;
}

Rgb blackbody_rgb(double kelvin) {
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
    return with_luminance_1({X, Y, Z});
}

const NamedColors& metals() {
    static const NamedColors colors = {{"metal-Ag-eta", {0.155265f, 0.116723f, 0.138381f}},
                                       {"metal-Ag-k", {4.828343f, 3.122246f, 2.146950f}},
                                       {"metal-Al-eta", {1.657460f, 0.880369f, 0.521229f}},
                                       {"metal-Al-k", {9.223869f, 6.269523f, 4.837001f}},
                                       {"metal-Au-eta", {0.143119f, 0.374957f, 1.442479f}},
                                       {"metal-Au-k", {3.983160f, 2.385721f, 1.603215f}},
                                       {"metal-Cu-eta", {0.200438f, 0.924033f, 1.102212f}},
                                       {"metal-Cu-k", {3.912949f, 2.452848f, 2.142188f}}};
    return colors;
}

const std::vector<Glass>& all_glasses() {
    static const std::vector<Glass> glasses = {{"glass-BAF10",
                                                {1.5851495, 0.143559385, 1.08521269},
                                                {0.00926681282, 0.0424489805, 105.613573}},
                                               {"glass-BK7",
                                                {1.03961212, 0.231792344, 1.01046945},
                                                {0.00600069867, 0.0200179144, 103.560653}},
                                               {"glass-F10",
                                                {1.62153902, 0.256287842, 1.64447552},
                                                {0.0122241457, 0.0595736775, 147.468793}},
                                               {"glass-F11",
                                                {1.73759695, 0.313747346, 1.89878101},
                                                {0.013188707, 0.0623068142, 155.23629}},
                                               {"glass-F5",
                                                {1.52481889, 0.187085527, 1.42729015},
                                                {0.011254756, 0.0588995392, 129.141675}},
                                               {"glass-FK51A",
                                                {0.971247817, 0.216901417, 0.904651666},
                                                {0.00472301995, 0.0153575612, 168.68133}},
                                               {"glass-LASF9",
                                                {2.00029547, 0.298926886, 1.80691843},
                                                {0.0121426017, 0.0538736236, 156.530829}}};
    return glasses;
}

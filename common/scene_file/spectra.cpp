#include "common/scene_file/spectra.h"

#include <array>

namespace {

// The CIE 1931 observer of 2 degrees: x, y, z from 380 nm on, every 10 nm.
constexpr double first_nm = 380, step_nm = 10;
constexpr std::array<std::array<double, 3>, 41> observer = {{
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

struct NamedMetal {
    const char* symbol;
    MetalIor ior;
};
constexpr std::array<NamedMetal, 4> metals = {{
    {"Ag", {{0.155265f, 0.116723f, 0.138381f}, {4.828343f, 3.122246f, 2.146950f}}},
    {"Al", {{1.657460f, 0.880369f, 0.521229f}, {9.223869f, 6.269523f, 4.837001f}}},
    {"Au", {{0.143119f, 0.374957f, 1.442479f}, {3.983160f, 2.385721f, 1.603215f}}},
    {"Cu", {{0.200438f, 0.924033f, 1.102212f}, {3.912949f, 2.452848f, 2.142188f}}},
}};

}  // namespace

Rgb blackbody_rgb(double kelvin) {
    constexpr double c2 = 1.438776877e-2;  // m K, the second radiation constant

    // Weigh the spectrum with the observer, relative to its value at 560 nm against underflow.
    double X = 0, Y = 0, Z = 0, nm = first_nm;
    for (const auto& [x, y, z] : observer) {
        double exponent = c2 / (nm * 1e-9 * kelvin), reference = c2 / (560e-9 * kelvin);
        double B = std::pow(560 / nm, 5) * std::exp(reference - exponent) * std::expm1(-reference) /
                   std::expm1(-exponent);
        X += B * x;
        Y += B * y;
        Z += B * z;
        nm += step_nm;
    }

    // Turn XYZ into linear sRGB, and give it luminance 1.         [IEC 61966-2-1]
    double r = std::max(0.0, 3.2406 * X - 1.5372 * Y - 0.4986 * Z);
    double g = std::max(0.0, -0.9689 * X + 1.8758 * Y + 0.0415 * Z);
    double b = std::max(0.0, 0.0557 * X - 0.2040 * Y + 1.0570 * Z);
    double scale = 1 / (0.2126 * r + 0.7152 * g + 0.0722 * b);
    return {static_cast<float>(scale * r), static_cast<float>(scale * g),
            static_cast<float>(scale * b)};
}

std::optional<MetalIor> metal_ior(const std::string& symbol) {
    for (const NamedMetal& metal : metals) {
        if (metal.symbol == symbol) return metal.ior;
    }
    return {};
}

std::vector<std::string> metal_symbols() {
    std::vector<std::string> symbols;
    for (const NamedMetal& metal : metals) symbols.push_back(metal.symbol);
    return symbols;
}

// Light and metals whose colors are known as spectra.
#include "common/scene_file/spectra.h"

#include <doctest/doctest.h>

#include <tuple>

#include "common/material/observer.h"
#include "tests/support/gates.h"

namespace {

/// How far two colors are apart in the worst channel.
float apart(Rgb a, Rgb b) {
    return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
}

}  // namespace

TEST_SUITE("spectra") {
    TEST_CASE("truth: black bodies have the chromaticities that the CIE gives") {
        for (auto [kelvin, x, y] : {std::tuple(2855.542, 0.44757, 0.40745),  // illuminant A
                                    {6500, 0.3135, 0.3237}}) {
            Rgb c = blackbody_rgb(kelvin);
            double X = 0.4124 * c.r + 0.3576 * c.g + 0.1805 * c.b;
            double Y = 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b;
            double Z = 0.0193 * c.r + 0.1192 * c.g + 0.9505 * c.b;
            CHECK(std::abs(X / (X + Y + Z) - x) < 2e-4);
            CHECK(std::abs(Y / (X + Y + Z) - y) < 2e-4);
            CHECK(std::abs(luminance(c) - 1) < 1e-5);
        }
        // Lines between rows of 10 nm make the observer's curves lower at their tops.
        CHECK(apart(light_rgb(standard_daylight()), illuminants().at("stdillum-D65")) < 3e-3f);
        CHECK(apart(illuminants().at("stdillum-A"), blackbody_rgb(2855.6)) < 3e-3f);
        // Daylight lies beside the line of black bodies.
        CHECK(apart(illuminants().at("stdillum-D50"), blackbody_rgb(5000)) < 0.06f);
    }

    TEST_CASE("truth: the observer's columns have the sums and centres of the CIE's table") {
        const double sums[3] = {10.683642, 10.685779, 10.6769};
        const double centres[3] = {6108.62642, 5986.08563, 4848.0652};  // sums of nm times column
        for (size_t k = 0; k < 3; k++) {
            double sum = 0, centre = 0;
            for (size_t i = 0; i < observer.size(); i++) {
                sum += observer[i][k];
                centre += observer[i][k] * (380 + 10 * static_cast<double>(i));
            }
            CHECK(sum == nearly(sums[k], 1e-9));
            CHECK(centre == nearly(centres[k], 1e-9));
        }
    }

    TEST_CASE("truth: what metals reflect at normal incidence") {
        // By their measured eta and k, at the wavelengths of red, green and blue.
        for (const auto& [name, R] : {std::pair("Ag", Rgb{0.975f, 0.958f, 0.906f}),
                                      std::pair("Al", Rgb{0.928f, 0.918f, 0.919f}),
                                      std::pair("Au", Rgb{0.967f, 0.802f, 0.324f}),
                                      std::pair("Cu", Rgb{0.952f, 0.620f, 0.511f})}) {
            Rgb n = metals().at("metal-" + std::string(name) + "-eta"),
                k = metals().at("metal-" + std::string(name) + "-k");
            auto F = [](float eta, float kappa) {
                float square = kappa * kappa;
                return ((eta - 1) * (eta - 1) + square) / ((eta + 1) * (eta + 1) + square);
            };
            CHECK(apart(R, {F(n.r, k.r), F(n.g, k.g), F(n.b, k.b)}) < 2e-3f);
        }
    }

    TEST_CASE("truth: colors of spectra, by quadrature") {
        // The observer and the spectrum as straight lines between what is known, in steps of 0.01
        // nm.
        auto line = [](const Spectrum& known, double nm) {
            for (size_t i = 1; i < known.size(); i++) {
                auto [a, low] = known[i - 1];
                auto [b, high] = known[i];
                if (nm >= a && nm <= b) return low + (high - low) * (nm - a) / (b - a);
            }
            return 0.0;
        };
        auto quadrature = [&](const Spectrum& spectrum, const Spectrum& light) {
            std::array<Spectrum, 3> curves;
            for (size_t i = 0; i < observer.size(); i++) {
                for (size_t k = 0; k < 3; k++) {
                    curves[k].push_back({380 + 10 * static_cast<double>(i), observer[i][k]});
                }
            }
            std::array<double, 3> xyz = {};
            for (double nm = 380.005; nm < 780; nm += 0.01) {
                double value = line(spectrum, nm) * line(light, nm);
                for (size_t k = 0; k < 3; k++) xyz[k] += value * line(curves[k], nm);
            }
            return srgb_from_xyz(xyz[0], xyz[1], xyz[2]);
        };
        const Spectrum even = {{300, 1}, {900, 1}},
                       band = {{400, 0}, {455, 0.9}, {520.5, 0.2}, {690, 1}},
                       step = {{380, 0.1}, {580, 0.1}, {582, 0.8}, {780, 0.8}};
        std::array<double, 3> white = quadrature(even, standard_daylight());
        for (const Spectrum& spectrum : {even, band, step}) {
            auto [r, g, b] = quadrature(spectrum, even);
            Rgb seen = {static_cast<float>(r), static_cast<float>(g), static_cast<float>(b)};
            CHECK(apart(light_rgb(spectrum), seen / luminance(seen)) < 1e-3f);
            std::array<double, 3> rgb = quadrature(spectrum, standard_daylight());
            for (size_t k = 0; k < 3; k++) rgb[k] = std::min(1.0, rgb[k] / white[k]);
            Rgb surface = {static_cast<float>(rgb[0]), static_cast<float>(rgb[1]),
                           static_cast<float>(rgb[2])};
            CHECK(apart(reflectance_rgb(spectrum), surface) < 1e-3f);
        }
    }
}

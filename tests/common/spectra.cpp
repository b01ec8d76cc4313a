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
            CHECK(std::abs(Y - 1) < 1e-5);
        }
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
}

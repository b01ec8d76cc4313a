// The pictures of chapters 01 to 04: what their programs draw is what their pages show.
#include <doctest/doctest.h>

#include "chapters/01_monte_carlo_pi/figure.h"
#include "chapters/02_stratification/figure.h"
#include "chapters/03_point_sets/figure.h"
#include "chapters/04_importance/figure.h"
#include "tests/support/scenes.h"

namespace {

/// How many pixels of the picture look other than on the page. The picture stands in the strip
/// of the page below a line of names, 24 pixels high, and between margins of 2 pixels.
int pixels_off(const Image& picture, const std::string& chapter) {
    Image strip = read_image("chapters/" + chapter + "/strip.png");
    REQUIRE(strip.width == picture.width + 4);
    REQUIRE(strip.height == picture.height + 24);
    int off = 0;
    for (int y = 0; y < picture.height; y++)
        for (int x = 0; x < picture.width; x++) {
            Rgb a = picture.at(x, y), b = strip.at(x + 2, y + 24);
            int difference = 0;
            for (float Rgb::*c : {&Rgb::r, &Rgb::g, &Rgb::b})
                difference = std::max(difference, std::abs(to_srgb8(a.*c) - to_srgb8(b.*c)));
            off += difference > 4;  // the strip has 256 colors
        }
    return off;
}

}  // namespace

TEST_SUITE("figures") {
    TEST_CASE("picture: chapters 01 to 04 draw what their pages show") {
        // Rounding differs between compilers: a dot may move by a pixel.
        CHECK(pixels_off(ch01::darts_picture(1000000, 0), "01_monte_carlo_pi") < 20);
        CHECK(pixels_off(ch02::sets_picture(0), "02_stratification") < 20);
        CHECK(pixels_off(ch03::sets_picture(0), "03_point_sets") < 20);
        CHECK(pixels_off(ch04::densities_picture(0), "04_importance") < 20);
    }
}

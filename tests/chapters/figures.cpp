// The pictures of chapters 01 to 04: what their programs draw is what their pages show.
#include <doctest/doctest.h>

#include "chapters/01_monte_carlo_pi/figure.h"
#include "chapters/02_stratification/figure.h"
#include "chapters/03_point_sets/figure.h"
#include "chapters/04_importance/figure.h"
#include "chapters/21_bidirectional/figure.h"
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

    TEST_CASE("picture: the pyramid has a row for each number of edges, and a place for each s") {
        Scene scene = scene_from("scenes/cornell.pbrt", 16, 1);
        scene.spp = 1;
        RenderOptions options;
        options.threads = 2;
        for (int edges : {2, 3}) {
            scene.max_depth = edges - 1;
            Image all = ch21::pyramid(scene, options);
            Tile tile = {Image(96, 96), {"s 0, t 3", "alone"}};
            Image empty = sheet(std::vector<Tile>(static_cast<size_t>(12 * (edges - 1)), tile), 12);
            CHECK(all.width == empty.width);
            CHECK(all.height == empty.height);
            // s = 0 finds the lamp by chance, s = 1 by light sampling: more light is found.
            int step = all.width / 12;
            auto light = [&](int column) {
                double sum = 0;
                for (int y = 8; y < 90; y++)
                    for (int x = 8; x < 90; x++)
                        sum += static_cast<double>(average(all.at(column * step + x, y)));
                return sum / 82 / 82;
            };
            CHECK(light(1) > 0.02);
            CHECK(light(7) < light(1));  // the same, weighted
            CHECK(light(5) ==
                  doctest::Approx(light(11)).scale(0));  // no such strategy: empty places
            CHECK(light(7) + light(6) > 0.5 * light(1));
        }
    }
}

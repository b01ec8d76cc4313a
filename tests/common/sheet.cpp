// Sheets of pictures with words, and that of --split.
#include "common/picture/sheet.h"

#include <doctest/doctest.h>

#include <algorithm>

#include "common/results/class_sheet.h"

namespace {

Image filled(int width, int height, Rgb color) {
    Image image(width, height);
    std::fill(image.pixels.begin(), image.pixels.end(), color);
    return image;
}

int count(const Image& image, Rgb color) {
    return static_cast<int>(std::count(image.pixels.begin(), image.pixels.end(), color));
}

/// Whether the words stand somewhere in the picture, ink for ink and paper for paper.
bool shows(const Image& image, const std::string& words) {
    Image nowhere;
    Image ink = filled(write_words(nowhere, 0, 0, words), 20, {1, 1, 1});
    write_words(ink, 0, 0, words);
    auto here = [&](int left, int top) {
        for (int y = 0; y < ink.height; y++) {
            for (int x = 0; x < ink.width; x++) {
                if (is_black(ink.at(x, y)) != is_black(image.at(left + x, top + y))) return false;
            }
        }
        return true;
    };
    for (int top = 0; top + ink.height <= image.height; top++) {
        for (int left = 0; left + ink.width <= image.width; left++) {
            if (here(left, top)) return true;
        }
    }
    return false;
}

Film film_of_one_value(int width, int height, float value) {
    Film film(width, height);
    for (size_t i = 0; i < film.pixels().size(); i++) film.add(i, {value, value, value});
    return film;
}

}  // namespace

TEST_SUITE("sheet") {
    TEST_CASE("identity: a shrunk picture has the means of its squares") {
        Image image(5, 4);
        for (int i = 0; i < 20; i++) image.at(i % 5, i / 5).g = static_cast<float>(i);
        Image small = shrunk(image, 2);
        REQUIRE(small.width == 2);
        REQUIRE(small.height == 2);
        CHECK(small.at(0, 0).g == (0 + 1 + 5 + 6) / 4.0f);
        CHECK(small.at(1, 1).g == (12 + 13 + 17 + 18) / 4.0f);
    }

    TEST_CASE("truth: the sheet of classes names each with its share, the brightest first") {
        std::map<std::string, Film> classes;
        classes.emplace("LDDE", film_of_one_value(20, 20, 0.1f));
        classes.emplace("LDE", film_of_one_value(20, 20, 0.7f));
        classes.emplace("LSE", film_of_one_value(20, 20, 0.2f));
        Image all = class_sheet(classes);
        for (const char* words :
             {"LDE  70 %", "LSE  20 %", "LDDE  10 %", "4x as bright", "8x as bright"})
            CHECK(shows(all, words));
        for (const char* words : {"LDE  71 %", "2x as bright"}) CHECK_FALSE(shows(all, words));
        CHECK(count(all, {0.7f, 0.7f, 0.7f}) == 400);
        CHECK(all.at(10, 10) == Rgb{0.7f, 0.7f, 0.7f});
    }
}

// Sheets of pictures with words, and that of --split.
#include "common/picture/sheet.h"

#include <doctest/doctest.h>

#include <algorithm>

#include "common/render/class_sheet.h"

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

    TEST_CASE("truth: the sheet of classes shows each, the brightest first, and words below") {
        std::map<std::string, Film> classes;
        for (auto [name, value] : {std::pair("LDDE", 0.1f), {"LDE", 0.7f}, {"LSE", 0.2f}}) {
            Film& film = classes.emplace(name, Film(20, 20)).first->second;
            for (size_t i = 0; i < 400; i++) film.add(i, {value, value, value});
        }
        Image all = class_sheet(classes), words = all;
        auto count = [&](float v) { return std::ranges::count(all.pixels, Rgb{v, v, v}); };
        CHECK(count(0.7f) == 400);
        CHECK(count(0.8f) == 800);  // the others are shown 4 and 8 times as bright
        CHECK(all.at(10, 10) == Rgb{0.7f, 0.7f, 0.7f});
        CHECK(count(0) > 200);  // letters
    }
}

// Pictures by another renderer: what our chapters must agree with.
#include <doctest/doctest.h>

#include "common/picture/image.h"
#include "tests/methods/table.h"
#include "tests/support/light_paths.h"

namespace {

/// Chapters that must agree with a picture: in the whole, and in blocks of side x side pixels.
struct Row {
    std::string scene;  // of tests/pictures/references, or the hall
    std::vector<std::string> methods;
    int spp, side;
    double relative_se, relative = 1;  // of the mean: joint error, and difference, at most
};

void check_rows(const std::vector<Row>& rows) {
    for (const Row& row : rows) {
        bool hall = row.scene == "hall";
        std::string folder = "tests/pictures/", stem = "references/" + row.scene;
        if (hall) stem = "real-scenes/modern-hall/reference";
        Scene scene = load_scene(
            folder + (hall ? "real-scenes/modern-hall/scene-v4" : stem) + ".pbrt", nullptr);
        scene.width = scene.height = 128;
        scene.max_depth = hall ? 16 : 100;
        prepare(scene, 2);
        // Each pixel of the error is one sample of the standard error there.
        Image image = read_image(folder + stem + ".pfm"),
              error = read_image(folder + stem + ".err.pfm");
        auto reference = [&](int x0, int y0, int side) -> Measured {
            double mean = 0, squares = 0, pixels = static_cast<double>(side) * side;
            for (int y = y0; y < y0 + side; y++)
                for (int x = x0; x < x0 + side; x++) {
                    mean += static_cast<double>(average(image.at(x, y)));
                    squares += std::pow(static_cast<double>(average(error.at(x, y))), 2);
                }
            return {mean / pixels, std::sqrt(squares) / pixels};
        };
        for (const std::string& name : row.methods) {
            CAPTURE(row.scene);
            CAPTURE(name);
            // Pixels of pictures with paths from lights do not know their error: that is measured.
            bool by_seeds = name >= "20";
            Method trace = method(name, scene);
            BlockMeans means = blocks_of(scene, trace, row.spp / 32, by_seeds ? 32 : 0, row.side);
            Film film = by_seeds ? Film(1, 1) : film_of(scene, trace, row.spp).film;
            Agreement a = hold_against(
                128, row.side,
                [&](int x, int y, int side) {
                    return by_seeds ? means.block(x, y, side) : block_of(film, x, y, side);
                },
                reference);
            check_agreement(a, row.relative_se);
            CHECK(a.relative < row.relative);
        }
    }
}

}  // namespace

TEST_SUITE("references") {
    TEST_CASE("agreement: the grey Cornell box, with chapter 08") {
        check_rows({{"cornell-grey", {"08"}, 32, 32, 0.01}});
    }
}

TEST_SUITE("references slow") {
    TEST_CASE("agreement: the grey Cornell box, with chapters 07 and 08") {
        check_rows({{"cornell-grey", {"07", "08"}, 1024, 8, 0.002, 0.01}});
    }

    TEST_CASE("agreement: plates, many lights, a caustic and a hall made by others") {
        check_rows({{"veach-mis", {"15"}, 2048, 8, 0.003, 0.005},
                    {"many-lights", {"15"}, 1024, 8, 0.001, 0.005},
                    {"hidden-bright", {"15"}, 1024, 8, 0.001, 0.005},
                    {"tiny-close-light", {"15"}, 1024, 8, 0.003, 0.005},
                    {"cornell-grey", {"15"}, 1024, 8, 0.001, 0.005},
                    {"hall", {"15"}, 64, 8, 0.002},
                    {"glass-caustic", {"07"}, 4096, 32, 0.015},
                    {"glass-caustic", {"21", "22"}, 256, 32, 0.01},
                    {"veach-mis", {"21", "22"}, 256, 32, 0.01},
                    {"cornell-grey", {"21", "22"}, 256, 32, 0.01}});
    }
}

// Pictures by another renderer: what our chapters must agree with.
#include <doctest/doctest.h>

#include "chapters/07_path_tracing/estimator.h"
#include "chapters/08_russian_roulette/estimator.h"
#include "chapters/15_mis_ris/estimator.h"
#include "chapters/21_bidirectional/estimator.h"
#include "chapters/22_fast_bidirectional/estimator.h"
#include "common/picture/image.h"
#include "tests/support/light_paths.h"

namespace {

/// A reference picture, and for each pixel one sample of its standard error.
struct Reference {
    Image image, error;

    /// name: without .pfm, below tests/pictures
    explicit Reference(const std::string& name)
        : image(read_image("tests/pictures/" + name + ".pfm")),
          error(read_image("tests/pictures/" + name + ".err.pfm")) {}

    Measured block(int x0, int y0, int side) const {
        double mean = 0, squares = 0, pixels = static_cast<double>(side) * side;
        for (int y = y0; y < y0 + side; y++)
            for (int x = x0; x < x0 + side; x++) {
                mean += static_cast<double>(average(image.at(x, y)));
                squares += std::pow(static_cast<double>(average(error.at(x, y))), 2);
            }
        return {mean / pixels, std::sqrt(squares) / pixels};
    }
};

/// Renders a scene and compares it with the reference, block by block.
///
/// make_trace  the chapter's trace, from the scene
template <class MakeTrace>
Agreement hold_against_reference(const Scene& scene, const Reference& reference,
                                 const MakeTrace& make_trace, int spp, int block_side) {
    Film film = film_of(scene, make_trace(scene), spp).film;
    return hold_against(
        128, block_side, [&](int x, int y, int side) { return block_of(film, x, y, side); },
        [&](int x, int y, int side) { return reference.block(x, y, side); });
}

/// The same with the scene that is beside the picture.
template <class MakeTrace>
Agreement hold_against_reference(const std::string& name, const MakeTrace& make_trace, int spp,
                                 int block_side) {
    Scene scene = scene_from("tests/pictures/references/" + name + ".pbrt", 128, 100);
    return hold_against_reference(scene, Reference("references/" + name), make_trace, spp,
                                  block_side);
}

// Each chapter's trace, from the scene.
Method seven(const Scene&) { return method_of<ch07::trace>(); }
Method eight(const Scene&) { return method_of<ch08::trace>(); }
Method fifteen(const Scene& scene) { return method_of<ch15::trace>(ch15::prepare(scene)); }

}  // namespace

TEST_SUITE("references") {
    TEST_CASE("agreement: the furnaces, with chapters 07 and 08") {
        for (auto chapter : {seven, eight}) {
            check_agreement(hold_against_reference("furnace", chapter, 16, 64), 0.001);
            check_agreement(hold_against_reference("furnace-glass", chapter, 4, 64), 0.001);
        }
    }

    TEST_CASE("agreement: the grey Cornell box, with chapter 08") {
        check_agreement(hold_against_reference("cornell-grey", eight, 32, 32), 0.01);
    }
}

TEST_SUITE("references slow") {
    TEST_CASE("agreement: the grey Cornell box, with chapters 07 and 08") {
        for (auto chapter : {seven, eight}) {
            Agreement a = hold_against_reference("cornell-grey", chapter, 1024, 8);
            check_agreement(a, 0.002);
            CHECK(a.relative < 0.01);
        }
    }

    TEST_CASE("agreement: plates, many lights, hidden and close lights, with chapter 15") {
        struct {
            std::string name;
            int spp;
            double relative_se;
        } cases[] = {{"veach-mis", 2048, 0.003},
                     {"many-lights", 1024, 0.001},
                     {"hidden-bright", 1024, 0.001},
                     {"tiny-close-light", 1024, 0.003},
                     {"cornell-grey", 1024, 0.001}};
        for (const auto& c : cases) {
            CAPTURE(c.name);
            Agreement a = hold_against_reference(c.name, fifteen, c.spp, 8);
            check_agreement(a, c.relative_se);
            CHECK(a.relative < 0.005);
        }
    }

    TEST_CASE("agreement: a furnished hall made by others, with chapter 15") {
        const std::string folder = "real-scenes/modern-hall";
        Scene scene = load_scene("tests/pictures/" + folder + "/scene-v4.pbrt", nullptr);
        scene.width = scene.height = 128;
        scene.max_depth = 16;
        prepare(scene, 2);
        Reference reference(folder + "/reference");
        check_agreement(hold_against_reference(scene, reference, fifteen, 64, 8), 0.002);
    }

    TEST_CASE("agreement: a caustic, found by chance") {
        check_agreement(hold_against_reference("glass-caustic", seven, 4096, 32), 0.015);
    }

    TEST_CASE("agreement: a caustic and plates, with chapters 21 and 22") {
        for (std::string name : {"glass-caustic", "veach-mis", "cornell-grey"}) {
            CAPTURE(name);
            Reference reference("references/" + name);
            Scene scene = scene_from("tests/pictures/references/" + name + ".pbrt", 128, 100);
            Method lesson = method_of<ch21::trace>(endpoints_of(scene));
            Method fast = method_of<ch22::trace>(ch22::prepare(scene));
            for (const Method& trace : {lesson, fast}) {
                BlockMeans means = blocks_of(scene, trace, 8, 32, 32);
                check_agreement(
                    hold_against(
                        128, 32, [&](int x, int y, int side) { return means.block(x, y, side); },
                        [&](int x, int y, int side) { return reference.block(x, y, side); }),
                    0.01);
            }
        }
    }
}

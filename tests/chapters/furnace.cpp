// A room in which light is the same everywhere, whatever stands in it: every chapter must find it.
#include "tests/support/chapters.h"
// In this order: names of a lower chapter must not be found through a higher one.
#include "tests/traces/18.h"
#include "tests/traces/21.h"
#include "tests/traces/22.h"
#include "common/picture/image.h"
#include "tests/support/folder.h"

namespace {

/// Lamps emit 1 and reflect a half; all else reflects or refracts all light. Around them stands a
/// sphere that is such a lamp too, or a sky of radiance 2. So the radiance is 1 + 1/2 + 1/4 + ... =
/// 2 in every direction, at every point.
Scene furnace(const std::string& around, const std::string& things) {
    Scene scene = scene_of(
        "LookAt 0 0 -7  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 60\n"
        "Film \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 16\nWorldBegin\n" +
        around + things);
    scene.max_depth = 80;
    return scene;
}
std::string lamp(const std::string& shape) {
    return "AttributeBegin Material \"diffuse\" \"rgb reflectance\" [.5 .5 .5] AreaLightSource "
           "\"diffuse\" \"rgb L\" [1 1 1] \"bool twosided\" true " +
           shape + " AttributeEnd ";
}
std::string thing(const std::string& material, const std::string& shape) {
    return "AttributeBegin Material " + material + " " + shape + " AttributeEnd ";
}

const std::string sphere = lamp("Shape \"sphere\" \"float radius\" 10");
const std::string sky = "LightSource \"infinite\" \"rgb L\" [2 2 2] ";
const std::string lamps =
    lamp("Translate -1.5 1 0 Rotate 40 1 1 0 Shape \"disk\" \"float radius\" 1") +
    lamp("Translate 1.5 1.2 1 Rotate 70 1 0 2 " + square(0, true)) +
    lamp("Translate 0 -1.8 -1 Shape \"sphere\" \"float radius\" 0.4") +
    lamp(
        "Shape \"trianglemesh\" \"point3 P\" [-3 -2 1  -1 -2 2  -2 0 1  -2 -1 3] \"integer "
        "indices\" [0 1 2 1 3 2]");
const std::string things =
    thing("\"dielectric\"", "Translate 0.4 0.3 -2 Shape \"sphere\" \"float radius\" 0.7") +
    thing("\"conductor\" \"rgb reflectance\" [1 1 1]",
          "Translate -1.2 -0.6 -2 Shape \"sphere\" \"float radius\" 0.6") +
    thing("\"diffuse\" \"rgb reflectance\" [1 1 1]",
          "Translate 1.4 -1 -1.5 Shape \"sphere\" \"float radius\" 0.5");

void check_is_two(const Scene& scene, const Method& trace, int paths) {
    Measured m = census_of(scene, trace, paths, 1).all.measured(paths);
    CHECK(std::abs(m.mean - 2) < 5 * m.se);
    CHECK(m.se < 0.02);
}

}  // namespace

TEST_SUITE("furnace of all things") {
    TEST_CASE("furnace: lamps of every shape, that shine to both sides, and mirrors and glass" *
              doctest::skip()) {
        for (const std::string& around : {sphere, sky}) {
            CAPTURE(around);
            Scene scene = furnace(around, lamps + things);
            std::vector<Chapter> chapters = every_chapter(scene);
            chapters.push_back(
                {"18", method_of<ch18::trace>(ch18::prepare(scene), shares_of_white())});
            for (const Chapter& chapter : chapters) {
                CAPTURE(chapter.name);
                int paths = 25000;
                Measured m = census_of(scene, chapter.trace, paths, 1).all.measured(paths);
                CHECK(std::abs(m.mean - 2) < 5 * m.se);
                CHECK(m.se < 0.02);
            }
        }
    }

    TEST_CASE("furnace: the same, by paths from both ends") {
        for (const std::string& around : {sphere, sky}) {
            CAPTURE(around);
            Scene scene = furnace(around, lamps + things);
            check_is_two(scene, method_of<ch21::trace>(endpoints_of(scene)), 15000);
            check_is_two(scene, method_of<ch22::trace>(ch22::prepare(scene)), 30000);
        }
    }

    TEST_CASE("agreement: the same, each length and class of path by one end and by both" *
              doctest::skip()) {
        // A mirror and glass fill the picture: light from mirrors is seen in mirrors.
        Scene scene = furnace(
            sphere, lamps + things +
                        thing("\"dielectric\"",
                              "Translate 0.8 0.4 -4 Shape \"sphere\" \"float radius\" 0.9") +
                        thing("\"conductor\" \"rgb reflectance\" [1 1 1]",
                              "Translate -1 -0.4 -4 Shape \"sphere\" \"float radius\" 0.8"));
        scene.max_depth = 6;
        CHECK(check_classes(scene, method_of<ch15::trace>(ch15::prepare(scene)), scene,
                            method_of<ch22::trace>(ch22::prepare(scene)), 100000) > 40);
    }

    TEST_CASE("furnace: a sky in mirrors and glass that fill the scene, by paths from both ends") {
        // They are so near to each other that paths from the sky find what they show as often as
        // paths from the eye do.
        Scene scene =
            furnace(sky, thing("\"diffuse\" \"rgb reflectance\" [1 1 1]",
                               "Translate 0 -1 0 Rotate 20 1 0 0 " + square(0, true)) +
                             thing("\"conductor\" \"rgb reflectance\" [1 1 1]",
                                   "Translate -0.5 -0.4 0 Shape \"sphere\" \"float radius\" 0.5") +
                             thing("\"dielectric\"",
                                   "Translate 0.5 -0.4 0 Shape \"sphere\" \"float radius\" 0.5"));
        check_is_two(scene, method_of<ch21::trace>(endpoints_of(scene)), 15000);
        check_is_two(scene, method_of<ch22::trace>(ch22::prepare(scene)), 60000);
    }
}

TEST_SUITE("textures in all chapters") {
    TEST_CASE("furnace: under a sky of radiance 1 a picture's mean is the mean of its texture") {
        // The square reaches beyond the film, which sees one whole period of the texture.
        TemporaryFolder folder;
        Image picture(5, 3);
        Sampler random = random_numbers(7);
        double mean = 0;
        for (Rgb& r : picture.pixels) {
            r = {random.u1(), random.u1(), random.u1()};
            mean += double{average(r)} / static_cast<double>(picture.pixels.size());
        }
        write_image(folder / "a.pfm", picture, "");
        std::string half = std::to_string(16 * std::tan(std::numbers::pi / 9));
        Scene scene = world_of(
            "LightSource \"infinite\" Texture \"t\" \"spectrum\" \"imagemap\" \"string "
            "filename\" \"" +
            folder / "a.pfm" +
            "\" \"float uscale\" 4 \"float vscale\" 4 Material \"diffuse\" "
            "\"texture reflectance\" \"t\" Scale " +
            half + " " + half +
            " 1 Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 P\" "
            "[-1 -1 0 -1 1 0 1 1 0 1 -1 0] \"point2 uv\" [0 0 0 1 1 1 1 0]");
        std::vector<Chapter> chapters = every_chapter(scene);
        chapters.push_back({"18", method_of<ch18::trace>(ch18::prepare(scene), shares_of_white())});
        auto check = [&](const auto& trace) {
            int paths = 20000;
            Measured m = census_of(scene, trace, paths, 1).all.measured(paths);
            CHECK(std::abs(m.mean - mean) < 5 * m.se);
            CHECK(m.se < 0.005);
        };
        for (const Chapter& chapter : chapters) {
            CAPTURE(chapter.name);
            check(chapter.trace);
        }
        check(method_of<ch21::trace>(endpoints_of(scene)));
        check(method_of<ch22::trace>(ch22::prepare(scene)));
    }

    TEST_CASE(
        "agreement: each length and class of path in globe.pbrt, whose surfaces have "
        "textures") {
        Scene scene = load_scene("scenes/globe.pbrt", nullptr);
        prepare(scene, 1);
        scene.width = scene.height = 32, scene.max_depth = 4;
        REQUIRE(scene.textures.all.size() == 4);
        Method by_chapter_10 = method_of<ch10::trace>();
        for (const Chapter& chapter : every_chapter(scene)) {
            CAPTURE(chapter.name);
            check_classes(scene, by_chapter_10, scene, chapter.trace, 20000);
        }
        check_classes(scene, by_chapter_10, scene, method_of<ch21::trace>(endpoints_of(scene)),
                      20000);
        check_classes(scene, by_chapter_10, scene, method_of<ch22::trace>(ch22::prepare(scene)),
                      20000);
    }
}

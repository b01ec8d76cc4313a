// What programs say where a picture is black, or darker than it should be.
#include <doctest/doctest.h>

#include "common/base/files.h"
#include "common/picture/image.h"
#include "common/picture/stats_file.h"
#include "tests/support/folder.h"
#include "tests/support/run_program.h"

namespace {

/// What a program says of a scene.
struct Said {
    std::string out;
    double mean = 0, error = 0;

    bool says(const std::string& text) const { return out.find(text) != std::string::npos; }
    bool warns() const { return says("warning: "); }
};

Said said_of(const std::string& program, const std::string& scene, const Words& more = {}) {
    TemporaryFolder folder;
    std::string file = folder / "scene.pbrt";
    write_file_atomically(file, scene);
    Words words = {file,    "--size",         "16x16",   "--spp",          "4",
                   "--out", folder / "a.pfm", "--stats", folder / "a.json"};
    words.insert(words.end(), more.begin(), more.end());
    Finished end = run(program, words);
    CAPTURE(end.err);
    REQUIRE(end.code == 0);
    StatsFile stats(read_file(folder / "a.json"));
    return {end.out, stats.number("mean").value(),
            stats.number("standard_error").value_or(INFINITY)};
}

const std::string camera =
    "LookAt 0 2 -4  0 0.3 0  0 1 0 Camera \"perspective\" \"float fov\" 30 WorldBegin\n";
const std::string floor_2 =
    "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 P\" [-2 0 -2  -2 0 2  2 0 2 "
    " 2 0 -2]\n";
std::string floor_of(const std::string& reflectance) {
    return "Material \"diffuse\" \"rgb reflectance\" [" + reflectance + "]\n" + floor_2;
}
const std::string grey_floor = floor_of("0.5 0.5 0.5");
/// A black lamp of these shapes.
std::string lamp(const std::string& shapes, const std::string& L = "10 10 10") {
    return "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [" + L +
           "] Material \"diffuse\" \"rgb reflectance\" [0 0 0]\n" + shapes + "AttributeEnd\n";
}
std::string ball(const std::string& at, const std::string& radius) {
    return "Translate " + at + " Shape \"sphere\" \"float radius\" " + radius + "\n";
}
std::string in(const std::string& material, const std::string& shapes) {
    return "AttributeBegin " + material + "\n" + shapes + "AttributeEnd\n";
}
const std::string upwards = "Translate 0 5 0 Rotate -90 1 0 0 Shape \"disk\"\n";
const std::string downwards = "Translate 0 5 0 Rotate 90 1 0 0 Shape \"disk\"\n";

}  // namespace

TEST_SUITE("warnings") {
    TEST_CASE("truth: a sky alone is as bright as it is, and there is nothing to warn of") {
        for (std::string shapes : {"", "Material \"interface\" Shape \"sphere\""})
            for (std::string program :
                 {"05_ray_casting", "09_light_sampling", "15_mis_ris", "19_adaptive",
                  "21_bidirectional", "22_fast_bidirectional", "25_vertex_merging"}) {
                CAPTURE(program);
                Said sky = said_of(program, camera + "LightSource \"infinite\"\n" + shapes,
                                   {"--stand-in", "--spp", "16"});
                CHECK(sky.mean == 1);
                CHECK(!sky.warns());
            }
    }

    TEST_CASE("failure: a black picture names what makes it black") {
        const std::string plain = "14_mis", by_chance = "07_path_tracing",
                          by_light = "20_light_tracing";
        std::string high_lamp = lamp(ball("0 5 0", "0.3")), speck = lamp(ball("0 5 0", "1e-4"));
        std::string bulb = in("Material \"dielectric\"", ball("0 5 0", "1"));
        std::string wall = in("Material \"diffuse\"", "Translate 0 4.5 0 Scale 3 1 3 " + floor_2);
        struct {
            std::string cause, program, scene;
            Words more = {};
        } cases[] = {
            {"the lights face away from all that is in view (", plain,
             camera + grey_floor + lamp(upwards)},
            {"all surfaces in view face away from the lights", plain,
             "LookAt 0 -2 -4  0 -0.3 0  0 1 0 Camera \"perspective\" \"float fov\" 10 "
             "WorldBegin\n" +
                 grey_floor + high_lamp},
            {"something stands between the lights and all that is in view",
             plain,
             camera + grey_floor + high_lamp + wall,
             {"--max-depth", "1"}},
            {"with a depth of 1 light comes straight from the lights alone",
             plain,
             camera + grey_floor + high_lamp + wall,
             {"--max-depth", "1"}},
            {"light comes to what is in view only through glass", plain,
             camera + grey_floor + speck + bulb},
            {"this chapter finds lights only by chance, by about one path in ", by_chance,
             camera + grey_floor + speck},
            {"few of them come to what the camera sees", by_light,
             "LookAt 0 2 -4  0 0.3 0  0 1 0 Camera \"perspective\" \"float fov\" 0.01 "
             "WorldBegin\n" +
                 grey_floor + high_lamp},
            {"the camera sees no surface", plain,
             "LookAt 0 2 -4  0 9 0  0 1 0 Camera \"perspective\" WorldBegin\n" + grey_floor +
                 lamp("Translate 0 -5 0 " + downwards)},
            {"it may be inside something", plain,
             camera + in("Material \"diffuse\"", ball("0 2 -4", "1")) + high_lamp},
            {"with a depth of 0 only lights themselves are seen",
             plain,
             camera + grey_floor + high_lamp,
             {"--max-depth", "0"}},
            {"all surfaces in view are black", plain, camera + floor_of("0 0 0") + high_lamp},
            {"the camera sees mirrors and glass alone", plain,
             camera + in("Material \"conductor\"", floor_2) + lamp(upwards)},
            {"--paths keeps no class of path that brings light",
             plain,
             camera + grey_floor + high_lamp,
             {"--paths", "LSSSE"}},
        };
        for (const auto& c : cases) {
            CAPTURE(c.cause);
            Said said = said_of(c.program, c.scene, c.more);
            CAPTURE(said.out);
            CHECK(said.mean == 0);
            CHECK(said.says("warning: the picture is black: no sample found light\n"));
            CHECK(said.says("warning: possible cause: "));
            CHECK(said.says(c.cause));
        }
    }

    TEST_CASE("failure: the program of every chapter says that a picture is black, and why") {
        for (const std::string& program : programs(true)) {
            CAPTURE(program);
            Said dark = said_of(program, camera + grey_floor + lamp(upwards));
            CHECK(dark.mean == 0);
            CHECK(dark.says("warning: the picture is black: no sample found light\n"));
            CHECK(dark.says(
                "warning: possible cause: the lights face away from all that is in view"));
            Said lit = said_of(program, camera + grey_floor + "LightSource \"infinite\"\n");
            CHECK_FALSE(lit.says("black"));
        }
    }

    TEST_CASE("failure: metal that is nearly a mirror hides light, and a warning says so") {
        // A lamp, a plate of metal and a floor that both light: most pictures miss what the plate
        // sends to the floor, a sixth of all.
        auto scene = [](const std::string& alpha, const std::string& radius,
                        const std::string& reflectance) {
            double r = std::stod(radius);
            std::string L = std::to_string(1 / r / r);
            return "LookAt 0.2 3 -0.5  0.2 0 0  0 1 0 Camera \"perspective\" \"float fov\" 20 "
                   "WorldBegin\n" +
                   lamp(ball("-0.5 1.5 0", radius), L + " " + L + " " + L) +
                   in("Material \"conductor\" \"rgb reflectance\" [" + reflectance +
                          "] \"bool remaproughness\" false \"float roughness\" " + alpha,
                      "Translate 1 1 0 Rotate 90 0 0 1 Scale 0.5 1 0.5 " + floor_2) +
                   grey_floor;
        };
        const std::string bright = "0.9 0.9 0.9",
                          warning = "via nearly smooth metal is found only by chance";
        // No chapter samples lights via the metal, and the lamp is small.
        for (const char* program : {"13_glossy", "14_mis", "15_mis_ris", "16_lens_and_shutter",
                                    "17_sky_image", "18_dispersion", "19_adaptive"})
            for (const char* alpha : {"0.001", "0.002", "0.005", "0.01"}) {
                CAPTURE(program);
                CAPTURE(alpha);
                Words spp = {"--spp", program[1] == '9' ? "16" : "4"};
                CHECK(said_of(program, scene(alpha, "0.02", bright), spp).says(warning));
            }
        // Rough metal, a large lamp, a black plate or many samples: nothing is hidden.
        CHECK_FALSE(said_of("15_mis_ris", scene("0.2", "0.02", bright)).says(warning));
        CHECK_FALSE(said_of("15_mis_ris", scene("0.005", "0.7", bright)).says(warning));
        CHECK_FALSE(said_of("15_mis_ris", scene("0.005", "0.02", "0 0 0")).says(warning));
        CHECK_FALSE(
            said_of("15_mis_ris", scene("0.02", "0.02", bright), {"--spp", "1024"}).says(warning));
        // Paths from both ends find it.
        for (std::string both_ends : {"21_bidirectional", "22_fast_bidirectional"})
            CHECK_FALSE(said_of(both_ends, scene("0.005", "0.02", bright)).says(warning));
    }

    TEST_CASE("failure: paths from lights miss what nearly mirrors show, and a warning says so") {
        const std::string warning = "metal that is nearly a mirror: few paths from a light leave";
        // A plate of metal that shows a lamp: the warning names the runs whose intervals miss the
        // truth, however smooth the plate is.
        auto plate = [](const std::string& alpha, const std::string& reflectance) {
            return "LookAt 0 1.5 -3  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 40 "
                   "WorldBegin\n" +
                   lamp(ball("0 1.5 3", "0.4"), "6 6 6") +
                   in("Material \"conductor\" \"rgb reflectance\" [" + reflectance +
                          "] \"bool remaproughness\" false \"float roughness\" " + alpha,
                      "Scale 0.5 1 0.5 " + floor_2) +
                   in("", "Translate 0 -0.5 0 Scale 3 1 3 " + grey_floor);
        };
        struct Count {
            int right = 0, wrong = 0, right_named = 0, wrong_named = 0;
        };
        auto count = [&](const std::string& scene, const std::string& spp, int seeds, Count& n) {
            Said truth = said_of("15_mis_ris", scene, {"--spp", "1024"});
            for (int seed = 1; seed <= seeds; seed++) {
                Said said = said_of("20_light_tracing", scene,
                                    {"--spp", spp, "--seed", std::to_string(seed)});
                bool is_right =
                    std::abs(said.mean - truth.mean) <= 2 * std::hypot(said.error, truth.error);
                (is_right ? n.right : n.wrong)++;
                (is_right ? n.right_named : n.wrong_named) += said.says(warning);
            }
        };
        Count plates;
        for (const char* alpha : {"0.001", "0.004", "0.01"})
            for (const char* spp : {"4", "64"}) count(plate(alpha, "0.9 0.9 0.9"), spp, 5, plates);
        CHECK(plates.wrong >= 15);
        CHECK(plates.wrong_named >= 0.9 * plates.wrong);
        CHECK(plates.right_named <= 0.05 * plates.right);
        // Where most intervals cover the truth, most runs have no warning.
        Count lamps;
        count(read_file("scenes/veach-mis.pbrt"), "64", 12, lamps);
        CHECK(lamps.right >= 6);
        CHECK(lamps.right_named <= 1);
        // Nothing is missed: the plate is black or rough.
        CHECK_FALSE(said_of("20_light_tracing", plate("0.001", "0 0 0")).says(warning));
        CHECK_FALSE(said_of("20_light_tracing", plate("0.2", "0.9 0.9 0.9")).says(warning));
    }

    TEST_CASE(
        "failure: chapter 05 says that it leaves out light from surface to surface and from the "
        "sky") {
        const std::string program = "05_ray_casting", high_lamp = lamp(ball("0 5 0", "0.3")),
                          warning =
                              "warning: light that one surface reflects to another is left out\n";
        auto beside_floor = [&](const std::string& reflectance) {
            return camera + grey_floor + high_lamp +
                   in("", "Translate 0 1 1 Rotate -90 1 0 0 " + floor_of(reflectance));
        };
        for (const char* reflectance : {"0.2 0.2 0.2", "0.9 0.9 0.9"}) {
            Said four = said_of(program, beside_floor(reflectance), {"--spp", "16"});
            Said all = said_of("15_mis_ris", beside_floor(reflectance), {"--spp", "64"});
            CHECK(four.mean + 2 * four.error < all.mean - 2 * all.error);
            CHECK(four.says(warning));
        }
        const std::string sky_warning =
                              "warning: light that surfaces receive from the sky is left out",
                          sky = "LightSource \"infinite\"\n";
        CHECK(said_of(program, camera + sky + grey_floor + high_lamp).says(sky_warning));
        CHECK_FALSE(said_of(program, camera + sky + floor_of("0 0 0")).says(sky_warning));
        CHECK_FALSE(said_of(program, beside_floor("0.5 0.5 0.5")).says(sky_warning));
        // Where it leaves out nothing, it does not say so.
        const std::string alone = camera + grey_floor + high_lamp;
        CHECK_FALSE(said_of(program, alone).says(warning));
        CHECK_FALSE(said_of(program, beside_floor("0 0 0")).says(warning));
        CHECK_FALSE(
            said_of(program, beside_floor("0.5 0.5 0.5"), {"--max-depth", "1"}).says(warning));
    }

    TEST_CASE(
        "truth: metal that reflects nothing in a channel sends nothing less, in any chapter") {
        TemporaryFolder folder;
        for (const std::string& program : programs(true))
            for (const char* roughness : {"0", "0.1"}) {
                bool is_early = program < "13";
                if (is_early && roughness[1] != 0) continue;
                CAPTURE(program);
                std::string metal =
                    "Material \"conductor\" \"rgb reflectance\" [0.9 0 0] \"float roughness\" " +
                    std::string(roughness);
                said_of(program,
                        camera + in(metal, ball("0 0.5 0", "0.5") + floor_2) +
                            lamp(ball("0 5 0", "2")) + "LightSource \"infinite\"\n",
                        {"--size", "32x32", "--out", folder / "b.pfm"});
                float lowest = 0;
                for (Rgb L : read_image(folder / "b.pfm").pixels)
                    lowest = std::min({lowest, L.r, L.g, L.b});
                CHECK(lowest == 0);
            }
    }
}

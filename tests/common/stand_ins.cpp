// Stand-ins: what is read with --stand-in, what is said of it, and where.
#include <doctest/doctest.h>

#include <sstream>

#include "common/base/files.h"
#include "common/material/spectrum.h"
#include "common/picture/image.h"
#include "common/scene/prepare.h"
#include "common/scene/texture.h"
#include "common/scene_file/reader.h"
#include "tests/support/described.h"
#include "tests/support/folder.h"
#include "tests/support/scenes.h"

namespace {

/// A scene with files beside it, its text with ' for ".
struct Files {
    TemporaryFolder folder;

    Files() {
        Image image(2, 2);
        image.pixels = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
        write_image(folder / "a.png", image, "");
        image.pixels = {{0.1f, 0, 0}, {0.3f, 0.5f, 0}, {0.5f, 1, 0}, {0.7f, 1.5f, 1}};
        write_image(folder / "a.pfm", image, "");
        write("a.exr", "\x76\x2f\x31\x01...");
        write("a.pbrt", "Shape 'sphere' Translate 1 0 0");
        write("a.ply", read_file("tests/support/triangle.ply"));
    }
    void write(const std::string& name, const std::string& text) const {
        write_file_atomically(folder / name, unquoted(text));
    }
    Scene read(const std::string& text, bool stand_ins = true) const {
        return parse_scene(folder / "s.pbrt", unquoted(text), nullptr, {}, {}, stand_ins);
    }
    Scene world(const std::string& text) const {
        return read("Camera 'perspective' WorldBegin\n" + text + " Shape 'sphere'");
    }
    /// The first line of a lit world, which is its last sphere's or, without its own, its light's.
    std::string described(const std::string& text, const std::string& kind) const {
        std::string words = in_words(world(text));
        size_t at = words.find(kind + " ");
        return at == words.npos ? "" : words.substr(at, words.find('\n', at) - at);
    }
};

Rgb abs_of(Rgb a) { return {std::abs(a.r), std::abs(a.g), std::abs(a.b)}; }

const std::string light = "LightSource 'infinite' ";

}  // namespace

TEST_SUITE("stand-ins") {
    TEST_CASE("input: all that pbrt-v4's files may say is read, or has a stand-in") {
        Files files;
        std::istringstream lines(read_file("tests/support/pbrt_v4.txt"));
        int read = 0, replaced = 0;
        for (std::string line; std::getline(lines, line);) {
            if (line.starts_with("##")) continue;
            CAPTURE(line);
            std::string text = line.substr(2);
            const std::string world =
                "WorldBegin Texture 'noise' 'float' 'fbm' Texture 'noise2' 'float' 'constant' "
                "Texture 'wood' 'spectrum' 'imagemap' 'string filename' 'a.png' ";
            const std::string rest = light + "Shape 'sphere' ";
            bool has_camera = text.find("Camera") != std::string::npos && line[0] != 'w';
            std::string scene = has_camera ? "" : "\nCamera 'perspective' ";
            scene += line[0] == 'w' ? world + rest + text : text + ' ' + world + rest;
            std::string refused = error_of([&] { files.read(scene, false); });
            Scene with;
            CHECK(error_of([&] { with = files.read(scene); }) == "");
            CHECK(with.origin->stand_ins.empty() == refused.empty());
            std::istringstream errors(refused);
            for (std::string error; std::getline(errors, error);) {
                bool is_missing = error.ends_with("cannot read: No such file or directory");
                CHECK((is_missing || error.find(" --stand-in renders it as ") != error.npos));
            }
            (refused.empty() ? read : replaced)++;
        }
        CHECK(read == 49);
        CHECK(replaced == 122);
    }

    TEST_CASE("truth: what stands in has the mean of what it stands for") {
        Files files;
        const std::string wood =
            "Texture 'n' 'float' 'fbm' Texture 'wood' 'spectrum' 'imagemap' 'string filename' "
            "'a.png' ";
        auto metal = [](const std::string& name) {
            const auto& known = metals();
            return "metal " + in_words(known.at("metal-" + name + "-eta")) + ", " +
                   in_words(known.at("metal-" + name + "-k"));
        };
        const std::string of_gold = metal("Au"), of_copper = metal("Cu");
        auto texture = [](const std::string& kind) {
            return "Texture 't' 'spectrum' " + kind +
                   " Material 'diffuse' 'texture reflectance' 't'";
        };
        const std::pair<std::string, std::string> materials[] = {
            {"Material 'coateddiffuse' 'rgb reflectance' [.1 .2 .3]", "0.1 0.2 0.3"},
            {"Material 'diffusetransmission' 'rgb reflectance' [.4 .5 .6] 'float scale' .5",
             "0.4 0.5 0.6"},
            {"Material 'coatedconductor' 'spectrum conductor.eta' 'metal-Au-eta' 'spectrum "
             "conductor.k' 'metal-Au-k' 'texture conductor.roughness' 'n'",
             of_gold + ", 0"},
            {"Material 'conductor' 'float uroughness' .1 'float vroughness' .4 "
             "'bool remaproughness' false",
             of_copper + ", 0.2"},
            {"Material 'dielectric' 'float roughness' .3 'float eta' 1.4", "glass 1.4"},
            {"Material 'dielectric' 'spectrum eta' [300 1.7 900 1.7]", "glass 1.5"},
            {"Material 'diffuse' 'spectrum reflectance' [300 .1 900 .1]", "0.5 0.5 0.5"},
            {"Material 'conductor' 'texture roughness' 'n'", of_copper + ", 0"},
            {"Material 'mix' 'string materials' ['a' 'b'] 'float amount' .6", "0.5 0.5 0.5"},
            {texture("'imagemap' 'string filename' 'a.png' 'string mapping' 'planar' "
                     "'float scale' .5"),
             "0.5 0.5 0.5"},
            {texture("'imagemap' 'string filename' 'a.exr'"), "0.5 0.5 0.5"},
            {texture("'marble'"), "0.5 0.5 0.5"},
            {texture("'checkerboard' 'integer dimension' 3 'rgb tex1' [.2 .4 .6]"), "0.5 0.5 0.5"},
            {texture("'scale' 'rgb tex' [.2 .4 .6] 'float scale' 2"), "0.5 0.5 0.5"},
            {"Attribute 'texture' 'rgb value' [.1 .1 .1] " + texture("'constant'"), "0.1 0.1 0.1"},
        };
        for (const auto& [text, looks] : materials) {
            CAPTURE(text);
            CHECK(files.described(light + wood + text, "sphere") == "sphere 0 0 0, 1 " + looks);
        }
        for (const std::string kind :
             {"'imagemap' 'string filename' 'a.png'",
              "'checkerboard' 'rgb tex1' [.4 .4 .4] 'rgb tex2' [.6 .6 .6]"})
            CHECK(files.described(light + texture(kind) +
                                      " Shape 'trianglemesh' 'point3 P' [0 0 0 1 0 0 0 1 0]",
                                  "triangle") == "triangle 0 0 0 1 0 0 0 1 0 0.5 0.5 0.5");
        const std::pair<std::string, std::string> lights[] = {
            {"LightSource 'spot' 'point3 from' [1 2 3] 'rgb I' [4 5 6]", "point 4 5 6, 1 2 3"},
            {"LightSource 'spot' 'float power' 10", "point 0.79577 0.79577 0.79577, 0 0 0"},
            {"LightSource 'spot' 'spectrum I' [400 2 700 2]", "point 1 1 1, 0 0 0"},
            {"LightSource 'projection' 'float power' 10", "point 0.79577 0.79577 0.79577, 0 0 0"},
            {"LightSource 'infinite' 'string filename' 'a.exr' 'float scale' 3",
             "infinite 1.5 1.5 1.5"},
            {"LightSource 'infinite' 'string filename' 'none.exr' 'float illuminance' 3",
             "infinite 0.47746 0.47746 0.47746"},
        };
        for (const auto& [text, shines] : lights)
            CHECK(files.described(text, shines.substr(0, shines.find(' '))) == shines);

        // Spheres and disks of one scale, and cameras of another kind.
        CHECK(files.described(light + "Scale 2 1 4", "sphere").starts_with("sphere 0 0 0, 2 "));
        CHECK(files.described(light + "Scale 2 4 9 Shape 'disk'", "disk") ==
              "disk 0 0 0, 0 0 1, 2 0.5 0.5 0.5");
        Camera camera =
            files.read("Camera 'realistic' 'float lensradius' 1 WorldBegin " + light).camera;
        CHECK(camera.fov == 90);
        CHECK(camera.lens_radius == 0);
        // What is left out leaves no light behind; a clear shape is no shape, unless it shines.
        Scene left = files.world(
            light +
            "AttributeBegin AreaLightSource 'diffuse' Material 'interface' Shape 'sphere' "
            "AttributeEnd Shape 'sphere' 'float alpha' 0");
        CHECK(left.geometry.size() == 1);
        CHECK(left.lights.size() == 1);
        CHECK(files.world(light + "Material 'none'").geometry.spheres.empty());
        // pbrt imports a file as if it stood in a block.
        CHECK(files.world(light + "Import 'a.pbrt'").geometry.spheres[1].c.x == 0);
        // A picture of the sky stands for its mean in chapters without one.
        Scene sky = files.read(
            "Camera 'perspective' WorldBegin\nShape 'sphere'\nLightSource "
            "'infinite' 'string filename' 'a.pfm' 'float scale' 3 LightSource "
            "'infinite' 'rgb L' [1 2 3]");
        fit_features(sky, features_of(16), true);
        prepare(sky, 1);
        CHECK(in_words(sky.sky) == "2.2 4.25 3.75");
        CHECK(sky.origin->stand_ins.size() == 1);
        CHECK(sky.origin->stand_ins[0].first.line == 3);
    }

    TEST_CASE("truth: a .jpg and a .tga have the colors of the .png that they were made of") {
        auto corpus = [](const std::string& name) {
            return read_file("tests/damage/corpus/" + name);
        };
        const std::string png = corpus("sky.png"), jpg = corpus("sky.jpg");
        Image truth = decode_image("a.png", png);
        for (auto [name, error] : {std::pair("sky.tga", 0.0), std::pair("sky.jpg", 0.03)}) {
            std::string file = name, bytes = corpus(name);
            Image image = decode_image(file, bytes);
            REQUIRE(image.pixels.size() == truth.pixels.size());
            double sum = 0;
            for (size_t i = 0; i < truth.pixels.size(); i++)
                sum += double{max_component(abs_of(image.pixels[i] - truth.pixels[i]))};
            CHECK(sum <= error * static_cast<double>(truth.pixels.size()));
            for (size_t length = 0; length < bytes.size(); length++)
                CHECK_THROWS_AS(decode_image(file, bytes.substr(0, length)), InputError);
        }
        // What stands in the segments of a .jpg is no marker; endings may be capitals.
        const std::string table = "\xff\xc4\1\1" + std::string(200, '\xff'), end = "\xff\xd9";
        for (const char* kind : {"\xe1", "\xed", "\xfe"}) {  // Exif, Photoshop, a comment
            const std::string begin =
                jpg.substr(0, 2) + "\xff" + kind + std::string("\0\xd0", 2) + table + end;
            CHECK(decode_image("a.JPG", begin + jpg.substr(2)).pixels ==
                  decode_image("a.jpg", jpg).pixels);
            CHECK_THROWS_AS(decode_image("a.jpg", begin + jpg.substr(2, jpg.size() - 5)),
                            InputError);
        }
    }

    TEST_CASE("input: files that gzip packed") {
        // As gzip packs a.pbrt, with a name in the header.
        std::string packed(
            "\037\213\010\010\000\000\000\000\002\377\141\000\013\316\110\054\110\125\120"
            "\052\056\310\110\055\112\125\122\010\051\112\314\053\316\111\054\111\125\060"
            "\124\060\120\060\000\000\133\034\267\265\036\000\000\000",
            52);
        Files files;
        write_file_atomically(files.folder / "a.pbrt.gz", packed);
        CHECK(files.world(light + "Include 'a.pbrt.gz'").geometry.spheres.size() == 2);
        // What gzip makes of an empty file: two bytes of data, then a checksum and a length of 0.
        const std::string none("\x1f\x8b\x08\0\0\0\0\0\0\3\3\0\0\0\0\0\0\0\0\0", 20);
        CHECK(unpack_gzip("none", none) == "");
        CHECK_THROWS_AS(unpack_gzip("short", packed.substr(0, 51)), InputError);
        CHECK_THROWS_AS(unpack_gzip("parts", packed + "more"), InputError);
        packed[packed.size() - 6] ^= 1;
        CHECK_THROWS_AS(unpack_gzip("damaged", packed), InputError);
    }
}

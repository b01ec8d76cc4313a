// What the scene reader makes of each feature of the language.
#include "common/scene_file/reader.h"

#include <doctest/doctest.h>

#include "common/base/files.h"
#include "common/material/spectrum.h"
#include "common/scene/prepare.h"
#include "tests/support/described.h"
#include "tests/support/folder.h"

namespace {

/// A piece of a scene with ' for ", and what must be read of it.
struct Row {
    std::string text, expected;
};

/// Reads what stands before the world.
Scene read_options(const std::string& text) {
    return parse_scene("scene.pbrt",
                       unquoted(text + " WorldBegin LightSource 'point' Shape 'sphere'"), nullptr);
}
const std::string camera = " Camera 'perspective' ", grey = " 0.5 0.5 0.5";

/// The lines of a world but those of its first disk and sky, which let anything be a scene. Paint
/// of the default reflectance is left out.
std::string described(const std::string& text, std::vector<std::string>* notes = nullptr) {
    std::string words = in_words(read_world(text, notes));
    for (const char* line : {"disk 0 0 0, 0 0 1, 1 0.5 0.5 0.5\n", "infinite 1 1 1\n"})
        words.erase(words.find(line), std::string(line).size());
    for (size_t at; (at = words.find(grey)) != std::string::npos;) words.erase(at, grey.size());
    return words;
}

void check_described(const std::vector<Row>& rows) {
    for (const Row& row : rows) {
        CAPTURE(row.text);
        CHECK(described(row.text) == row.expected + (row.expected.empty() ? "" : "\n"));
    }
}

const std::string triangle = "Shape 'trianglemesh' 'point3 P' [0 0 0 1 0 0 0 1 0] ";
const std::string quad =
    "Shape 'trianglemesh' 'integer indices' [0 1 2 0 2 3] 'point3 P' [0 0 0 2 0 0 2 1 0 0 1 0] ";
const std::string sphere = " Shape 'sphere' ";

}  // namespace

TEST_SUITE("reader") {
    TEST_CASE("input: camera, film, sampler and integrator, and pbrt's defaults") {
        for (const Row& row : std::vector<Row>{
                 {camera, "1280x720 16 5 90 at 0 0 0, 1 0 0, 0 1 0, 0 0 1"},
                 {"Sampler 'independent'" + camera, "1280x720 4 5 90"},
                 {"Sampler 'stratified'" + camera, "1280x720 16 5 90"},
                 {"Sampler 'stratified' 'integer xsamples' 3 'integer ysamples' 5 'bool jitter' "
                  "false" +
                      camera,
                  "1280x720 15 5 90"},
                 {"Sampler 'pmj02bn' 'integer pixelsamples' 9" + camera, "1280x720 9 5 90"},
                 {"Integrator 'path'" + camera, "1280x720 16 5 90"},
                 {"Integrator 'path' 'integer maxdepth' 0 'string lightsampler' 'bvh'" + camera,
                  "1280x720 16 0 90"},
                 {"Integrator 'bdpt' 'integer maxdepth' 64 'bool visualizeweights' true" + camera,
                  "1280x720 16 64 90"},
                 {"Film 'rgb' 'integer xresolution' 320 'integer yresolution' 200 'string "
                  "filename' "
                  "'a.exr' 'float diagonal' 35 Camera 'perspective' 'float fov' 19.5 "
                  "'float frameaspectratio' 2 'float screenwindow' [-1 2 -3 4] "
                  "'float lensradius' .5 'float focaldistance' 7",
                  "320x200 16 5 19.5 at 0 0 0, 1 0 0, 0 1 0, 0 0 1, lens 0.5 7, frame 2, "
                  "window -1 2 -3 4"},
                 // The axes of a pinhole come near 1, those of a lens keep their size.
                 {"Scale 3 3 3" + camera, "1280x720 16 5 90 at 0 0 0, 1.3333 0 0, 0 1.3333 0"},
                 {"Scale .5 .5 .5 Camera 'perspective' 'float lensradius' 1",
                  "1280x720 16 5 90 at 0 0 0, 2 0 0, 0 2 0, 0 0 2, lens 1 1e+06"},
                 // The camera takes the transform where it stands, left-handed.
                 {"LookAt 1 2 3  1 2 -7  0 9 0" + camera + "Translate 1 1 1",
                  "1280x720 16 5 90 at 1 2 3, -1 0 0, 0 1 0, 0 0 -1"},
                 // Scale -1 1 1 in front mirrors the picture and nothing else.
                 {"Scale -1 1 1 LookAt 1 2 3  1 2 -7  0 9 0" + camera,
                  "1280x720 16 5 90 at 1 2 3, 1 0 0, 0 1 0, 0 0 -1"}}) {
            CAPTURE(row.text);
            CHECK(settings_of(read_options(row.text)).starts_with(row.expected));
        }
        CHECK(read_options(camera).origin->file == "scene.pbrt");
        // The shutter scales the lights as it scales pbrt's film.
        CHECK(read_options("Camera 'perspective' 'float shutteropen' 1 'float shutterclose' 3")
                  .lights[0]
                  .L == Rgb{2, 2, 2});
    }

    TEST_CASE("input: comments, line ends, brackets and blanks do not matter") {
        Scene s =
            parse_scene("scene.pbrt",
                        unquoted("\xef\xbb\xbf# a scene\r\n"
                                 "Film\t'rgb''integer   xresolution'[64]# the width\r\n"
                                 "#'integer xresolution' 128\r"
                                 "'integer yresolution' # between\r\n [ # inside\r\n +32 ]\r\n"
                                 "Sampler 'independent' 'integer pixelsamples' [ 7 ]\r\n"
                                 "Integrator 'path' 'integer maxdepth' [\r\n9\r\n]\r\n"
                                 "LookAt +0e0 0 -4.E0 0 0 0 0 1.0 0\r"
                                 "Camera 'perspective' 'float fov' [.4e2] WorldBegin\r\n\r\n"
                                 "LightSource 'infinite' 'rgb L' [1 2000.e-3 30E-1]\r\n"
                                 "Material 'diffuse' 'rgb\treflectance' [ 25e-2 +.5 0.75 ]\r\n"
                                 "Shape 'trianglemesh' 'normal N' [ 0 -0 1 0 0 1 0 0 1 ]"
                                 "'point3 P'[0 0 0 1 0 0 0 1 0]#the end"),
                        nullptr);
        CHECK(settings_of(s) == "64x32 7 9 40 at 0 0 -4, 1 0 0, 0 1 0, 0 0 1");
        CHECK(in_words(s) ==
              "triangle 0 0 0 (0 0 1) 1 0 0 (0 0 1) 0 1 0 (0 0 1) 0.25 0.5 0.75\n"
              "infinite 1 2 3\n");
    }

    TEST_CASE("input: what is replaced, ignored or given twice is noted with its place") {
        std::vector<std::string> notes;
        parse_scene(
            "s",
            unquoted("PixelFilter 'gaussian' 'float sigma' 1\nSampler 'halton'\n"
                     "Integrator 'bdpt'\n  Accelerator 'kdtree' ColorSpace 'rec2020'\n"
                     "Option 'Disable-Pixel_Jitter' true\n"
                     "Film 'rgb' 'float maxcomponentvalue' 10 'bool savefp16' false\n"
                     "Camera 'perspective' 'float fov' 9 'float fov' 45\n"
                     "  Camera 'perspective' WorldBegin LightSource 'point' Shape 'sphere'"),
            &notes);
        std::string places;
        for (const std::string& note : notes) places += note.substr(1, note.find(": note: "));
        CHECK(places == ":1:1::2:1::3:1::4:3::4:24::5:1::6:1:");
        notes.clear();
        described("Shape 'bilinearmesh' 'point3 P' [0 0 0 1 0 0 0 1 0 1 1 0]", &notes);
        CHECK(notes.at(0).starts_with("scene.pbrt:2:1: note: "));
        CHECK(notes.at(1).starts_with("scene.pbrt: note: no PixelFilter"));
        // What is too small is left out, and nothing that is empty moves.
        const std::string tiny =
            "Scale 1e-10 1e-10 1e-10 ActiveTransform EndTime Translate 1 0 0\n";
        CHECK(read_world(tiny + triangle).movers.empty());
    }

    TEST_CASE("input: every transform directive does what pbrt's does") {
        for (const Row& row : std::vector<Row>{
                 {"", "1 2 3"},  // the place of the point (1, 2, 3)
                 {"Translate 10 20 30", "11 22 33"},
                 {"Scale 2 -3 4", "2 -6 12"},
                 {"Rotate 90 0 0 7", "-2 1 3"},
                 {"Rotate 90 1 0 0", "1 -3 2"},
                 {"Rotate 90 0 1 0", "3 2 -1"},
                 {"Rotate -120 1 1 1", "2 3 1"},
                 // Columns of the matrix one after the other: the translation is in places 13
                 // to 15.
                 {"Transform [2 0 0 0  0 0 1 0  0 -1 0 0  10 20 30 1]", "12 17 32"},
                 {"Translate 1 1 1 Transform [1 0 0 0 0 1 0 0 0 0 1 0 5 5 5 1]", "6 7 8"},
                 {"Translate 1 1 1 ConcatTransform [1 0 0 0 0 1 0 0 0 0 1 0 5 5 5 1]", "7 8 9"},
                 {"Translate 1 1 1 Identity", "1 2 3"},
                 {"TransformBegin Scale 9 9 9 TransformEnd", "1 2 3"},
                 {"Translate 1 1 1 AttributeBegin Scale 9 9 9 AttributeBegin Identity AttributeEnd "
                  "AttributeEnd Translate 1 1 1",
                  "3 4 5"},
                 // For both ends of the shutter: no motion.
                 {"ActiveTransform StartTime Translate 1 0 0 ActiveTransform EndTime Translate 1 0 "
                  "0 ActiveTransform All Translate 1 0 0",
                  "3 2 3"},
                 {"AttributeBegin ActiveTransform EndTime AttributeEnd Translate 1 0 0", "2 2 3"}})
            check_described({{row.text + " LightSource 'point' 'point3 from' [1 2 3]",
                              "point 1 1 1, " + row.expected}});
    }

    TEST_CASE("input: the order of a triangle's corners is the side that shines") {
        // A transform that mirrors does not change the side: the normal is carried along. The
        // vertices' normals decide, whatever the corners say, unless they say nothing.
        for (auto [normals, sign] : {std::pair("", 1.0f),
                                     {"'normal N' [0 0 -1 0 0 -1 0 0 -1]", -1},
                                     {"'normal N' [0 0 0 0 0 0 0 0 0]", 1},
                                     {"'normal N' [1 0 0 0 1 0 1 1 0]", 1}}) {
            for (auto [before, turn] : {std::pair("", 1.0f),
                                        {"ReverseOrientation ", -1},
                                        {"ReverseOrientation ReverseOrientation ", 1},
                                        {"Scale -1 1 1 ", 1},
                                        {"Scale 1 1 -1 ", -1}}) {
                const std::string world = before + triangle + normals;
                CAPTURE(world);
                Geometry g = read_world(world).geometry;
                CHECK(normalize(normal_of(g, g.triangles[0])) == Vec3{0, 0, turn * sign});
            }
        }
    }

    TEST_CASE("input: each shape in world space, and meshes with their triangles in order") {
        auto leaning = [](const std::string& n) { return triangle + "'normal N' " + n; };
        auto corners = [](const std::string& x, const std::string& n) {
            return "triangle 0 0 0 " + n + " " + x + " 0 0 " + n + " 0 " + x + " 0 " + n;
        };
        const std::string slanted = leaning("[0 .6 .8 0 .6 .8 0 .6 .8] "),
                          whole_disk =
                              " Shape 'disk' 'float radius' 2 'float height' 3 "
                              "'float innerradius' 0 'float phimax' 360";
        check_described({
            {"Translate 10 0 0 " + quad +
                 "'point2 uv' [0 0 1 0 1 1 0 1] 'vector3 S' [1 0 0 1 0 0 1 0 0 1 0 0] "
                 "'integer faceIndices' [7 8]",
             "triangle 10 0 0 12 0 0 12 1 0\ntriangle 10 0 0 12 1 0 10 1 0"},
            {"Translate 1 2 3 Rotate 30 1 2 3 Scale -2 2 2 Shape 'sphere' 'float radius' 1.5 "
             "'float zmin' -1.5 'float zmax' 1.5 'float phimax' 360",
             "sphere 1 2 3, 3"},
            {whole_disk, "disk 0 0 3, 0 0 1, 2"},
            {"ReverseOrientation" + whole_disk, "disk 0 0 3, 0 0 -1, 2"},
            {"Scale -1 1 1" + whole_disk, "disk 0 0 3, 0 0 1, 2"},
            {"Scale 1 1 -1" + whole_disk, "disk 0 0 -3, 0 0 -1, 2"},
            {"Rotate 90 0 1 0" + whole_disk, "disk 3 0 0, 1 0 0, 2"},
            // Only what lies in the disk's plane must be scaled alike.
            {"Scale 3 3 10" + whole_disk, "disk 0 0 30, 0 0 1, 6"},
            {"ConcatTransform [1 0 0 0 0 1 0 0 5 0 1 0 0 0 0 1]" + whole_disk,
             "disk 15 0 3, 0 0 1, 2"},
            {"Shape 'bilinearmesh' 'point3 P' [0 0 0 2 0 0 0 1 0 2 1 0]",
             "triangle 0 0 0 2 0 0 2 1 0\ntriangle 0 0 0 2 1 0 0 1 0"},
            // Normals are carried as normals.
            {"Scale 10 10 10 " + slanted, corners("10", "(0 0.6 0.8)")},
            {"Scale 1 2 1 " + slanted,
             "triangle 0 0 0 (0 0.37798 1.0079) 1 0 0 (0 0.37798 1.0079) 0 2 0 "
             "(0 0.37798 1.0079)"},
            // Lengths are kept, by which pbrt weighs them, unless their squares leave a float.
            {leaning("[0 0 2  0 0 1.1e6  0 0 9e-7]"),
             "triangle 0 0 0 (0 0 2) 1 0 0 (0 0 1) 0 1 0 (0 0 1)"},
            // Every position has a normal once one has; meshes without get zeros.
            {triangle + slanted + triangle, corners("1", "(0 0 0)") + "\n" +
                                                corners("1", "(0 0.6 0.8)") + "\n" +
                                                corners("1", "(0 0 0)")},
            // Triangles without area are left out, also as lights.
            {"AreaLightSource 'diffuse' 'float power' 1 Shape 'trianglemesh' 'point3 P' "
             "[0 0 0 1 0 0 0 1 0 2 0 0] 'integer indices' [0 0 1  0 1 2  0 1 3]"
             "Shape 'trianglemesh' 'point3 P' [0 0 0 1 0 0 2 0 0]",
             "triangle 0 0 0 1 0 0 0 1 0 light 1\narea 0.63662 0.63662 0.63662, "
             "1 from 0"},
        });
        CHECK(read_world("ReverseOrientation " + slanted).geometry.normals[0].y == -0.6f);
    }

    TEST_CASE("input: metals by their reflectance, by eta and k, and by name; glass") {
        auto metal = [](Rgb eta, Rgb k, const char* alpha) {
            return "metal " + in_words(eta) + ", " + in_words(k) + ", " + alpha;
        };
        auto named = [](const char* name) { return metals().at(name); };
        const Rgb gold_k = named("metal-Au-k");
        auto rough = [&](const char* alpha) {
            return metal(named("metal-Cu-eta"), named("metal-Cu-k"), alpha);
        };
        for (const Row& row : std::vector<Row>{
                 {"'conductor' 'rgb eta' [.2 .9 1.1] 'rgb k' [3.9 2.4 2.1]",
                  "metal 0.2 0.9 1.1, 3.9 2.4 2.1, 0"},
                 {"'conductor' 'spectrum eta' 'metal-Au-eta' 'spectrum k' [ 'metal-Au-k' ]",
                  metal(named("metal-Au-eta"), gold_k, "0")},
                 {"'conductor'", rough("0")},
                 {"'conductor' 'rgb eta' [1 2 3]", metal({1, 2, 3}, named("metal-Cu-k"), "0")},
                 // R = k^2 / (4 + k^2); white is .9999, as in pbrt.
                 {"'conductor' 'rgb reflectance' [0 .5 1]", "metal 1 1 1, 0 2 199.97, 0"},
                 // Roughness is the square of alpha, unless it is alpha; below .001 it is smooth.
                 {"'conductor' 'float roughness' .25", rough("0.5")},
                 {"'conductor' 'float roughness' .25 'bool remaproughness' false", rough("0.25")},
                 {"'conductor' 'float roughness' .0009 'bool remaproughness' false", rough("0")},
                 {"'conductor' 'float roughness' .001 'bool remaproughness' false", rough("0.001")},
                 {"'dielectric'", "glass 1.5"},
                 {"'dielectric' 'float eta' 1.33 'float roughness' .9e-6", "glass 1.33"}})
            check_described({{"Material " + row.text + sphere, "sphere 0 0 0, 1 " + row.expected}});
    }

    TEST_CASE("input: materials hold up to AttributeEnd, and named ones before they are made") {
        check_described({
            {"NamedMaterial 'red'" + sphere +
                 "MakeNamedMaterial 'a\\'b\\\\c' 'rgb reflectance' [0 1 0] 'string type' 'diffuse' "
                 "MakeNamedMaterial 'red' 'string type' 'diffuse' 'rgb reflectance' [1 0 0]" +
                 sphere + "NamedMaterial 'a\\'b\\\\c'" + sphere,
             "sphere 0 0 0, 1 1 0 0\nsphere 0 0 0, 1 1 0 0\nsphere 0 0 0, 1 0 1 0"},
            {"AttributeBegin Material 'diffuse' 'rgb reflectance' [1 0 0] AreaLightSource "
             "'diffuse' ReverseOrientation Shape 'sphere' AttributeEnd" +
                 sphere,
             "sphere 0 0 0, 1 1 0 0 reversed light 1\nsphere 0 0 0, 1\narea 1 1 1, 1 from 0"},
            // What only bounds a medium is no surface.
            {"MakeNamedMaterial 'air' 'string type' 'interface' NamedMaterial 'air'" + sphere, ""},
            {"AttributeBegin Attribute 'shape' 'float radius' 3 'float height' 3 "
             "Attribute 'material' 'rgb reflectance' [1 0 0] Attribute 'shape' 'float radius' 2 "
             "Material 'diffuse' Shape 'sphere' Shape 'sphere' 'float radius' 4 Shape 'disk' "
             "AttributeEnd" +
                 sphere,
             "sphere 0 0 0, 2 1 0 0\nsphere 0 0 0, 4 1 0 0\nsphere 0 0 0, 1\ndisk 0 0 3, 0 0 1, 2 "
             "1 0 0"},
        });
    }

    TEST_CASE("input: each Shape of an area light is one light with its range of primitives") {
        Scene scene = read_world(
            "AreaLightSource 'diffuse' 'rgb L' [1 2 3] 'float scale' 2 'bool twosided' true\n"
            "Shape 'sphere'\n Shape 'disk'\n " +
            quad + quad +
            "AttributeBegin AreaLightSource 'diffuse' Shape 'sphere' AttributeEnd Shape 'disk'");
        std::string lights = in_words(scene);
        CHECK(lights.substr(lights.find("infinite")) ==
              "infinite 1 1 1\narea 2 4 6, both sides of 1 from 4\n"
              "area 2 4 6, both sides of 1 from 7\narea 2 4 6, both sides of 2 from 0\n"
              "area 2 4 6, both sides of 2 from 2\narea 1 1 1, 1 from 5\n"
              "area 2 4 6, both sides of 1 from 8\n");
        CHECK(place_text(*scene.lights[2].at) == "scene.pbrt:4:2");
        for (uint32_t i = 0; i < 4; i++)
            CHECK(scene.shapes[scene.geometry.triangles[i].shape].light == (i < 2 ? 3 : 4));
    }

    TEST_CASE("input: point, distant and infinite lights") {
        auto rgb = [](Rgb c) { return in_words(c); };
        check_described({
            {"LightSource 'point'", "point 1 1 1, 0 0 0"},
            {"Translate 0 2 3 LightSource 'point' 'rgb I' [1 2 3] 'float scale' 2 'point3 from' "
             "[1 2 3]",
             "point 2 4 6, 1 4 6"},
            {"LightSource 'point' 'float power' 100 'rgb I' [1 .5 2]",
             "point " + rgb(Rgb{100, 50, 200} / (4 * pi)) + ", 0 0 0"},
            {"LightSource 'point' 'blackbody I' 2856 'float scale' 3",
             "point " + rgb(3 * blackbody_rgb(2856)) + ", 0 0 0"},
            {"LightSource 'distant'", "distant 1 1 1, 0 0 -1"},
            {"Translate 0 2 3 LightSource 'distant' 'rgb L' [1 2 3] 'float scale' 2 "
             "'float illuminance' 10 'point3 from' [0 5 0] 'point3 to' [0 3 0]",
             "distant 20 40 60, 0 1 0"},
            {"LightSource 'infinite' 'rgb L' [1 2 3] 'float scale' 2", "infinite 2 4 6"},
            // illuminance is the irradiance pi L of a surface under the sky of L = 1.
            {"LightSource 'infinite' 'float illuminance' 10 'rgb L' [1 1 2]",
             "infinite " + rgb(Rgb{10, 10, 20} / pi)},
            // What is black is no light.
            {"AreaLightSource 'diffuse' 'rgb L' [0 0 0]" + sphere +
                 "LightSource 'point' 'float scale' 0",
             "sphere 0 0 0, 1"},
        });
        // A power or illuminance that is not above 0 has no effect, as in pbrt.
        for (const char* none : {"0", "-0.0", "-1e30"}) {
            for (const char* total : {"LightSource 'point' 'float power' ",
                                      "LightSource 'distant' 'float illuminance' ",
                                      "LightSource 'infinite' 'float illuminance' ",
                                      "AreaLightSource 'diffuse' 'float power' "}) {
                std::string with = total + std::string(none) + " 'float scale' 3" + sphere;
                std::string without(total, std::string(total).find(" 'float"));
                CHECK(described(with) == described(without + " 'float scale' 3" + sphere));
            }
        }
    }

    TEST_CASE("input: an object is copied to each of its instances, within the limits") {
        const std::string object =
            "Material 'diffuse' 'rgb reflectance' [1 0 0] ObjectBegin 'two' Translate 1 0 0 "
            "Shape 'sphere' AreaLightSource 'diffuse' Scale 2 2 2 Shape 'disk' ObjectEnd "
            "Material 'diffuse' ";
        const std::string twice =
            "ObjectInstance 'two' Rotate 90 0 0 1 Scale 3 3 3 ObjectInstance 'two' ";
        const std::string expected =
            "sphere 1 0 0, 1 1 0 0\nsphere 0 3 0, 3 1 0 0\n"
            "disk 1 0 0, 0 0 1, 2 1 0 0\ndisk 0 3 0, 0 0 1, 6 1 0 0";
        check_described(
            {{object + twice, expected}, {object, ""}, {twice + "Identity " + object, expected}});
        std::vector<std::string> notes;
        described(object + twice, &notes);
        CHECK(notes[0].ends_with("lights inside an object are left out, as in pbrt"));
        Limits limits;
        limits.primitives = 4;
        CHECK_THROWS_WITH(read_world(object + twice, nullptr, limits),
                          doctest::Contains("more than 4 primitives"));
    }

    TEST_CASE("files: an included file continues where its Include stands") {
        // From the included file, and named beside it; then its transform is still in force. The
        // mesh is named beside the main file.
        TemporaryFolder folder;
        std::filesystem::create_directory(folder / "parts");
        auto write = [&](const std::string& name, const std::string& text) {
            write_file_atomically(folder / name, unquoted(text));
        };
        write("main.pbrt",
              "Camera 'perspective' WorldBegin LightSource 'infinite' Include 'parts/first.pbrt' "
              "Translate 0 5 0 Shape 'sphere'");
        write("parts/first.pbrt",
              "Translate 1 0 0 Material 'diffuse' 'rgb reflectance' [.2 .3 .4] Shape 'sphere' "
              "Include 'second.pbrt'");
        write("parts/second.pbrt",
              "Translate 2 0 0 Shape 'sphere' Shape 'plymesh' 'string filename' 'triangle.ply'");
        write("triangle.ply", read_file("tests/support/triangle.ply"));
        CHECK(in_words(load_scene(folder / "main.pbrt", nullptr)) ==
              "triangle 3 0 0 4 0 0 3 1 0 0.2 0.3 0.4\n"
              "sphere 1 0 0, 1 0.2 0.3 0.4\nsphere 3 0 0, 1 0.2 0.3 0.4\n"
              "sphere 3 5 0, 1 0.2 0.3 0.4\ninfinite 1 1 1\n");
    }
}

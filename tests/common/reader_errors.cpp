// Scenes and files that the reader must refuse, each with its own line; and where large ones end.
#include <doctest/doctest.h>

#include <fstream>

#include "common/base/files.h"
#include "tests/support/described.h"
#include "tests/support/folder.h"

namespace {

namespace fs = std::filesystem;

std::string refuse(const std::string& text, const Limits& limits = {},
                   const std::string& folder = "") {
    return error_of([&] { parse_scene(folder + "scene.pbrt", text, nullptr, {}, limits); });
}

// Writes a file, in a new folder within `folder` where the name has one, and returns its path.
std::string write(const TemporaryFolder& folder, const std::string& name,
                  const std::string& bytes) {
    fs::path path = folder / name;
    fs::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << bytes;
    return path.string();
}

std::string refuse_file(const std::string& path) {
    return error_of([&] { load_scene(path, nullptr); });
}

std::string repeated(const std::string& text, int times) {
    std::string all;
    for (int i = 0; i < times; i++) all += text;
    return all;
}

const std::string world = "Camera \"perspective\" WorldBegin LightSource \"infinite\"\n";

}  // namespace

TEST_SUITE("reader: malformed input") {
    TEST_CASE("input: every malformed scene is refused with its message and place") {
        const std::string folder = "tests/support/malformed/";
        auto cases = read_malformed_cases(folder + "scenes.txt");
        CHECK(cases.size() >= 150);
        for (const MalformedCase& c : cases) {
            std::string begin = c.in_world ? "Camera \"perspective\" WorldBegin\n" : "";
            std::string said = refuse(begin + c.input, {}, folder);
            for (size_t at; (at = said.find(folder)) != std::string::npos;) {
                said.erase(at, folder.size());
            }
            CHECK(said == c.message);
        }
    }

    TEST_CASE("input: what no text file can hold is refused in a line") {
        const std::string utf8 = "not UTF-8 text", unknown = "unknown directive ";
        struct {
            std::string text, place, message;
        } cases[] = {
            {"WorldBegin Shape \"sphere\" LightSource \"infinite\"", "", "no Camera"},
            {"# \xc3\xbc\xe2\x82\xac\xf0\x9f\x98\x80\xff", ":1:6", utf8},
            {{"\xff\xfe#\x00", 4}, ":1:1", utf8},  // UTF-16
            {"#\xed\xa0\x80", ":1:2", utf8},       // half of a character
            {std::string("A\x01\x7f\0B", 5), ":1:1", unknown + "\"A???B\""},
            {std::string(100, 'x'), ":1:1", unknown + '"' + std::string(60, 'x') + "...\""},
            // Lines end with LF, CR LF or CR.
            {"# one\r# \xff", ":2:3", utf8},
            {"# one\r\n\r\n  Camra", ":3:3", unknown + "\"Camra\": did you mean \"Camera\"?"},
            {"Camera \"perspec\rtive\"", ":1:8", "the string does not end on its line"},
        };
        for (const auto& c : cases)
            CHECK(refuse(c.text) == "scene.pbrt" + c.place + ": error: " + c.message);
    }

    TEST_CASE("input: after twenty different errors the rest is not read") {
        std::string text;
        for (size_t i = 0; i < 50; i++) text += "Nothing" + std::string(1 + i % 26, 'x') + "\n";
        std::string said = refuse(text);
        CHECK(std::count(said.begin(), said.end(), '\n') == 20);
        CHECK(said.ends_with("\nscene.pbrt: error: so much is wrong that the rest is not read"));
        // The same one counts once.
        CHECK(refuse(repeated("Textur\n", 50) + "Shap").find("\nscene.pbrt:51:1: error: ") !=
              std::string::npos);
    }

    TEST_CASE("files: errors name the included file, and files that include each other end") {
        TemporaryFolder folder;
        std::string a = write(folder, "a.pbrt", "Include \"sub/b.pbrt\"");
        write(folder, "sub/b.pbrt", "\n  Include \"../a.pbrt\"");
        CHECK(refuse_file(a).ends_with(": error: more than 100 files in each other"));
        CHECK(refuse_file(null_device).starts_with(null_device + ": error: "));
    }

    TEST_CASE("input: numbers up to their limits are read, and those beyond are refused") {
        const std::string view = "Camera 'perspective' ", end = view + "WorldBegin ",
                          ball = "Shape 'sphere' ", lit = "LightSource 'point' ",
                          metal = "Material 'conductor' ", glass = "Material 'dielectric' ",
                          mesh = "Shape 'trianglemesh' 'point3 P' ",
                          board =
                              "Texture 't' "
                              "'spectrum' 'checkerboard' ";
        struct {
            std::string text, inside, outside;  // @: the number
        } cases[] = {
            {view + "'float fov' @ WorldBegin ", "179.999", "179.9995"},
            {view + "'float screenwindow' [0 1 0 @] WorldBegin ", "1e-4", "0"},
            {view + "'float lensradius' @ WorldBegin ", "0", "-1"},
            {view + "'float shutterclose' @ WorldBegin ", ".01", "0"},
            {"Translate @ 0 0 " + end, "1e9", "1.1e9"},
            {"Scale @ @ @ " + end, "1.1e-6", ".9e-6"},
            {"Film 'rgb' 'integer xresolution' @ " + end, "65536", "65537"},
            {"Film 'rgb' 'integer xresolution' 16384 'integer yresolution' @ " + end, "16384",
             "16385"},
            {"Sampler 'sobol' 'integer pixelsamples' @ " + end, "16777216", "16777217"},
            {"Sampler 'stratified' 'integer ysamples' @ " + end, "1", "0"},
            {"Integrator 'path' 'integer maxdepth' @ " + end, "1073741824", "1073741825"},
            {lit + "'point3 from' [0 0 @]", "1e9", "1.1e9"},
            {lit + "'blackbody I' @", "500", "0"},
            {"AreaLightSource 'diffuse' 'float scale' @ " + ball, "9e14", "1.1e15"},
            {"Material 'diffuse' 'rgb reflectance' [0 0 @]", "1", "1.1"},
            {metal + "'rgb eta' [1 @ 1]", "1e4", "1.1e4"},
            {glass + "'bool remaproughness' false 'float roughness' @", ".0009", ".0011"},
            {ball + "'float radius' @", "1.1e-19", "1e-19"},
            {"Translate 9e8 0 0 " + ball + "'float radius' @", "9e7", "1.1e8"},
            {"Scale 1 @ 1 " + ball, "1.0009", "1.0011"},
            {"ConcatTransform [1 0 0 0 @ 1 0 0 0 0 1 0 0 0 0 1]" + ball, ".0009", ".0011"},
            {mesh + "[0 0 0 1 0 0 0 @ 0]", "1e9", "1.1e9"},
            {mesh + "[0 0 0 1 0 0 0 1 0] 'integer indices' [0 1 @]", "2", "3"},
            {mesh + "[0 0 0 1 0 0 0 1 0] 'integer indices' [@ 1 2]", "0", "-1"},
            // A shape is whole where pbrt clamps its limits to the whole.
            {ball + "'float zmin' @", "-2", "-.99"},
            {ball + "'float zmax' -1 'float zmin' @", "1", ".5"},
            {ball + "'float phimax' @", "360.5", "359"},
            {"Shape 'disk' 'float innerradius' @", "0", "-.5"},
            {board + "'float uscale' @", "1e9", "1.1e9"},
            {"Scale 1e-20 1e-20 @ " + lit, "1.1e-20", ".9e-20"},
            {"Transform [1 0 0 @ 0 1 0 0 0 0 1 0 0 0 0 1] " + lit, ".9e-6", "1.1e-6"},
            {"Transform [1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 @] " + lit, "1.0000009", "1.0000011"},
        };
        for (const auto& c : cases)
            for (const std::string& number : {c.inside, c.outside}) {
                std::string text = c.text;
                for (size_t at; (at = text.find('@')) != std::string::npos;)
                    text.replace(at, 1, number);
                CAPTURE(text);
                bool in_world = text.find("WorldBegin") == std::string::npos;
                std::string said = refuse((in_world ? world : "") + unquoted(text) +
                                          " LightSource \"infinite\" Identity Shape \"sphere\"");
                if (number == c.inside) CHECK(said == "");
                if (number == c.outside) CHECK(said.starts_with("scene.pbrt:"));
            }
    }

    TEST_CASE("input: a scene ends at the limits, each with its place") {
        const std::string sphere = "Shape \"sphere\"\n", disk = "Shape \"disk\"\n",
                          identity = "Identity ",
                          triangles = unquoted(
                              "Shape 'trianglemesh' 'point3 P' [0 0 0 1 0 0 1 1 0 0 1 0] "
                              "'integer indices' [0 1 2 0 2 3]\n");
        auto named = [](const std::string& begin, int count) {
            std::string text = begin;
            for (int i = 0; i < count; i++) text += " \"float x" + std::to_string(i) + "\" 1";
            return text;
        };
        Limits primitives, vertices, directives;
        primitives.primitives = 3, vertices.vertices = 3, directives.directives = 5;
        const std::string many = named("Shape \"sphere\"", 100);
        struct {
            Limits limits;
            std::string begin, one_more, place, message;
        } cases[] = {
            {primitives, sphere + sphere + disk, sphere, "5:1", "3 primitives"},
            {vertices, sphere, triangles, "3:1", "more than 3 vertices"},
            {directives, identity + sphere, identity, "3:1", "more than 5 directives"},
            {{},
             sphere,
             many + " \"float x\" 1",
             "3:1406",
             "more than 100 parameters of one directive"},
        };
        for (const auto& c : cases) {
            CHECK(refuse(world + c.begin, c.limits) == "");
            std::string said = refuse(world + c.begin + c.one_more, c.limits);
            CHECK(said.starts_with("scene.pbrt:" + c.place + ": error: "));
            CHECK(said.ends_with(c.message));
        }
    }
}

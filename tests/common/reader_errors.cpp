// Scenes and files that the reader must refuse, each with its own line.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "common/scene_file/reader.h"
#include "tests/support/folder.h"
#include "tests/support/malformed.h"

namespace {

namespace fs = std::filesystem;

std::string refuse(const std::string& text) {
    return error_of([&] { parse_scene("scene.pbrt", text, nullptr); });
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

}  // namespace

TEST_SUITE("reader: malformed input") {
    TEST_CASE("input: every malformed scene is refused with its message and place") {
        const std::string folder = "tests/support/malformed/";
        auto cases = read_malformed_cases(folder + "scenes.txt");
        CHECK(cases.size() >= 150);
        for (const MalformedCase& c : cases) {
            std::string world = c.in_world ? "Camera \"perspective\" WorldBegin\n" : "";
            std::string said =
                error_of([&] { parse_scene(folder + "scene.pbrt", world + c.input, nullptr); });
            for (size_t at; (at = said.find(folder)) != std::string::npos;) {
                said.erase(at, folder.size());
            }
            std::string expected = c.message;
            if (fs::path::preferred_separator == '\\') {  // a backslash stands between folders, too
                for (std::string* text : {&said, &expected}) {
                    text->erase(std::min(text->size(), text->find("; write / between folders")));
                    std::replace(text->begin(), text->end(), '\\', '/');
                }
            }
            CHECK(said == expected);
        }
    }

    TEST_CASE("input: a scene needs a camera, shapes and lights") {
        const std::string camera = "Camera \"perspective\"\n", world = "WorldBegin\n",
                          shape = "Shape \"sphere\"\n", light = "LightSource \"infinite\"\n";
        CHECK(refuse(world + shape + light) == "scene.pbrt: error: no Camera");
        CHECK(refuse(camera + world + light) == "scene.pbrt: error: no Shape");
        CHECK(refuse(camera + world + shape) ==
              "scene.pbrt: error: no light: the picture would be black");
        CHECK(refuse(camera) == "scene.pbrt: error: no WorldBegin");
        CHECK(refuse("") == "scene.pbrt: error: no WorldBegin");
        CHECK(refuse(camera + world + shape + light) == "");
    }

    TEST_CASE("input: text that is not UTF-8 is refused where it stands") {
        CHECK(refuse("Camera \"perspective\"\n# gr\xfc\xdf\n") ==
              "scene.pbrt:2:5: error: not UTF-8 text");
        CHECK(refuse("# \xc3\xbc\xe2\x82\xac\xf0\x9f\x98\x80\xff") ==
              "scene.pbrt:1:6: error: not UTF-8 text");
        for (const char* bad : {"\xc0\xaf", "\xe0\x80\xaf", "\xed\xa0\x80", "\xf4\x90\x80\x80",
                                "\xf8\x88\x80\x80\x80", "\xc3", "\x80"}) {
            CHECK(refuse(std::string("#") + bad) == "scene.pbrt:1:2: error: not UTF-8 text");
        }
        CHECK(refuse({"\xff\xfe#\x00", 4}) == "scene.pbrt: error: UTF-16 text: save it as UTF-8");
        CHECK(refuse({"\xfe\xff\x00#", 4}) == "scene.pbrt: error: UTF-16 text: save it as UTF-8");
        CHECK(refuse("\x1f\x8b\x08") == "scene.pbrt: error: compressed by gzip: unpack it first");
    }

    TEST_CASE("input: a message stays on one line and prints nothing that is not text") {
        CHECK(refuse("Camera \"a\\nb\"") ==
              "scene.pbrt:1:8: error: unknown Camera \"a?b\" (known: perspective)");
        CHECK(refuse(std::string("A\x01\x7f\0B", 5)) ==
              "scene.pbrt:1:1: error: unknown directive \"A???B\"");
        // Also what is a command to a terminal as UTF-8: U+009B, U+202E and U+2028.
        CHECK(refuse(std::string("A\xc2\x9b") + "31mB\xe2\x80\xae\xe2\x80\xa8") ==
              "scene.pbrt:1:1: error: unknown directive \"A?31mB??\"");
        std::string longest(100, 'x');
        CHECK(refuse(longest) ==
              "scene.pbrt:1:1: error: unknown directive \"" + longest.substr(0, 60) + "...\"");
    }

    TEST_CASE("input: a scene that is cut off anywhere is refused or whole, never half read") {
        const std::string scene =
            "LookAt 0 0 -4 0 0 0 0 1 0 Camera \"perspective\" \"float fov\" [ 40 ]\n"
            "WorldBegin\nLightSource \"infinite\" \"rgb L\" [ 1 1 1 ]\n"
            "AttributeBegin Material \"diffuse\" \"rgb reflectance\" [ .8 .8 .8 ]\n"
            "Shape \"trianglemesh\" \"integer indices\" [ 0 1 2 ]"
            " \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] AttributeEnd";
        for (size_t length = 0; length < scene.size(); length++) {
            CAPTURE(scene.substr(0, length));
            CHECK(refuse(scene.substr(0, length)) != "");
        }
        CHECK(refuse(scene) == "");
    }

    TEST_CASE("input: lines end with LF, CR LF or CR, in messages too") {
        for (const std::string end : {"\n", "\r\n", "\r"}) {
            CHECK(refuse("# one" + end + end + "  Camra \"perspective\"" + end) ==
                  "scene.pbrt:3:3: error: unknown directive \"Camra\": did you mean \"Camera\"?");
            CHECK(refuse("# one" + end + "# \xff") == "scene.pbrt:2:3: error: not UTF-8 text");
            CHECK(refuse("Camera \"perspec" + end + "tive\"") ==
                  "scene.pbrt:1:8: error: the string does not end on its line");
        }
    }

    TEST_CASE("input: after twenty different errors the rest is not read") {
        std::string text;
        for (size_t i = 0; i < 50; i++) text += "Nothing" + std::string(1 + i % 26, 'x') + "\n";
        std::string said = refuse(text);
        CHECK(std::count(said.begin(), said.end(), '\n') == 20);
        CHECK(said.ends_with("x\"\nscene.pbrt: error: so much is wrong that the rest is not read"));
        // The same one counts once.
        text.clear();
        for (int i = 0; i < 50; i++) text += "Textur\n";
        CHECK(refuse(text + "Shap") ==
              "scene.pbrt:1:1: error: unknown directive \"Textur\": did you mean \"Texture\"?\n"
              "scene.pbrt:51:1: error: unknown directive \"Shap\": did you mean \"Shape\"?");
    }

    TEST_CASE("input: every missing file is named, though other errors are cut off") {
        std::string text = "Camera \"perspective\" WorldBegin\n";
        const std::string mesh = "Shape \"plymesh\" \"string filename\" ";
        for (int i = 0; i < 40; i++) {
            text += mesh + "\"" + std::to_string(i) + ".ply\"\n" + mesh + "\"0.ply\"\n" +
                    "Include \"" + std::to_string(i) + ".pbrt\"\n";
        }
        std::string said = refuse(text + "Shap");
        CHECK(std::count(said.begin(), said.end(), '\n') == 80);
        for (int i = 0; i < 40; i++) {
            for (const char* kind : {".ply", ".pbrt"}) {
                CHECK(said.find('"' + std::to_string(i) + kind + "\": cannot read: No such file") !=
                      std::string::npos);
            }
        }
        CHECK(said.ends_with("error: unknown directive \"Shap\": did you mean \"Shape\"?"));
    }

    TEST_CASE("input: where all triangles are too small, the message says so") {
        const std::string camera = "Camera \"perspective\"\nWorldBegin\n",
                          light = "LightSource \"infinite\"\n", tiny = "Scale 1e-10 1e-10 1e-10\n",
                          emit = "AreaLightSource \"diffuse\"\n",
                          triangle = "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0]\n",
                          move = "ActiveTransform EndTime Translate 1 0 0\n";
        const std::string why =
            "all triangles of this Shape are too small (areas of 0, or below 5e-20: choose a "
            "smaller unit)";
        CHECK(refuse(camera + light + tiny + triangle + triangle) ==
              "scene.pbrt:5:1: error: no Shape is left: " + why);
        CHECK(refuse(camera + triangle + tiny + triangle + emit + triangle) ==
              "scene.pbrt:7:1: error: no light is left: " + why);
        CHECK(refuse(camera + emit + triangle + tiny + triangle) == "");

        // Where something is left, a note tells of what is not, and nothing that is empty moves.
        std::vector<std::string> notes;
        Scene scene =
            parse_scene("scene.pbrt", camera + light + triangle + tiny + move + triangle, &notes);
        CHECK(scene.movers.empty());
        CHECK(notes[0] ==
              "scene.pbrt:7:1: note: left out triangles without area: 1, which is all of them");
    }

    TEST_CASE("files: files that include each other end") {
        TemporaryFolder folder;
        std::string a = write(folder, "a.pbrt", "Include \"sub/b.pbrt\"");
        std::string b = write(folder, "sub/b.pbrt", "\n  Include \"../a.pbrt\"");
        CHECK(refuse_file(a) ==
              b + ":2:11: error: \"" + folder / "sub/../a.pbrt" + "\" includes itself");

        // Each of 100 files includes the next one twice: 2^100 files, if nobody counts.
        for (int i = 0; i < 100; i++) {
            std::string next = "Include \"" + std::to_string(i + 1) + "\"\n";
            write(folder, std::to_string(i), next + next);
        }
        write(folder, "100", "Identity");
        CHECK(refuse_file(folder / "0").ends_with("more than 10000 files are included"));
    }

    TEST_CASE("files: an error inside an included file names that file") {
        TemporaryFolder folder;
        std::string part = write(folder, "part.pbrt", "\nShape \"spere\"");
        std::string scene =
            write(folder, "scene.pbrt", "Camera \"perspective\" WorldBegin Include \"part.pbrt\"");
        CHECK(refuse_file(scene) ==
              part + ":2:7: error: unknown Shape \"spere\": did you mean \"sphere\"?");
        std::string ply = write(folder, "mesh.ply", "ply\nformat ascii 2.0\n");
        write(folder, "part.pbrt", "Shape \"plymesh\" \"string filename\" \"mesh.ply\"");
        CHECK(refuse_file(scene) == ply + ":2:14: error: unknown version \"2.0\"");
    }
}

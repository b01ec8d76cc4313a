// Names of files as each system has them, files that are open elsewhere, and the ends of lines.
#include <doctest/doctest.h>

#include <algorithm>

#include "common/picture/image.h"
#include "common/scene_file/reader.h"
#include "tests/support/run_program.h"

namespace fs = std::filesystem;

namespace {

const std::string
    strange = "Größe 日本 🎨",
    triangle =
        "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
        "property list uchar int vertex_indices\nend_header\n";

/// The text with CR LF for each LF.
std::string with_cr(const std::string& text) {
    std::string changed;
    for (char c : text) changed += c == '\n' ? "\r\n" : std::string(1, c);
    return changed;
}

}  // namespace

TEST_SUITE("names") {
    TEST_CASE("files: programs take names in any language, and a scene finds its files by them") {
        TemporaryFolder folder;
        std::string scene = folder / strange + ".pbrt", out = folder / strange + ".pfm";
        write_file_atomically(folder / strange + ".ply",
                              "ply\nformat ascii 1.0\n" + triangle + "0 0 3 1 0 3 0 1 3 3 0 1 2\n");
        write_file_atomically(
            scene,
            "PixelFilter \"box\" Camera \"perspective\"\nWorldBegin\nLightSource \"infinite\"\n"
            "Shape \"plymesh\" \"string filename\" \"" +
                strange + ".ply\"\n");
        Words words = {scene,   "--size", "9x7",
                       "--spp", "1",      "--out",
                       out,     "--film", folder / strange + ".film"};
        for (int times = 0; times < 2; times++) {
            Finished end = run(path_tracer, words);
            CHECK(end.code == 0);
            CHECK(end.err == "");
            CHECK(end.out.find(strange) != std::string::npos);
        }
        CHECK(read_image(out).width == 9);
        words[0] = folder / strange + ".none";
        CHECK(run(path_tracer, words).err ==
              words[0] + ": error: cannot read: No such file or directory\n");
    }

    TEST_CASE("files: what is being written is not removed, what was left over is") {
        TemporaryFolder folder;
        write_file_atomically(folder / "f.part-abcdefghijkl", "of a run that was killed");
        {
            NewFile file(folder / "f");
            file.write("half of i");
            CHECK(folder.names().size() == 1);
            check_writable(folder / "f");
            write_file_atomically(folder / "f", "by another");
            CHECK(folder.names().size() == 2);
            file.write("t");
            file.commit();
        }
        CHECK(read_file(folder / "f") == "half of it");
        CHECK(folder.names() == std::set<std::string>{"f"});
    }

    TEST_CASE("input: CR LF and LF end lines alike, in scenes and in headers of meshes") {
        TemporaryFolder folder;
        const std::string vertices(
            "\0\0\0\0\0\0\0\0\0\0\200?\0\0\200?\0\0\0\0\0\0\200?\0\0\0\0\0\0\200?\0\0\200?", 36),
            face("\3\0\0\0\0\1\0\0\0\2\0\0\0", 13);
        const std::string text =
            "Camera \"perspective\"\nWorldBegin # a comment\nLightSource \"infinite\"\n"
            "Shape \"plymesh\"\n  \"string filename\" \"binary.ply\"\n"
            "Shape \"plymesh\" \"string filename\" \"ascii.ply\"\n";
        for (bool cr : {false, true}) {
            auto ends = [&](const std::string& lines) { return cr ? with_cr(lines) : lines; };
            write_file_atomically(
                folder / "binary.ply",
                ends("ply\nformat binary_little_endian 1.0\n" + triangle) + vertices + face);
            write_file_atomically(folder / "ascii.ply", ends("ply\nformat ascii 1.0\n" + triangle +
                                                             "0 0 1\n1 0 1\n0 1 1\n3 0 1 2\n"));
            Scene scene = parse_scene(folder / "a.pbrt", ends(text), nullptr);
            REQUIRE(scene.geometry.positions.size() == 6);
            for (size_t i = 0; i < 3; i++)
                CHECK(scene.geometry.positions[i].z == scene.geometry.positions[i + 3].z);
            CHECK(error_of([&] {
                      parse_scene("a.pbrt", ends(text + "\n  Shap"), nullptr);
                  }).find("a.pbrt:8:3: error: ") != std::string::npos);
        }
    }
}

// Scenes that are not the same, though their bytes are.
#include <doctest/doctest.h>

#include <map>

#include "common/base/files.h"
#include "common/scene_file/reader.h"
#include "tests/support/folder.h"

TEST_SUITE("films of parts") {
    TEST_CASE("teeth: bytes that move to the next file of a scene make it another scene") {
        const std::string head = "Camera \"perspective\"\nWorldBegin\nLightSource \"infinite\"\n";
        auto include = [](const std::string& name) { return "Include \"" + name + "\"\n"; };
        auto mesh = [](const std::string& name) {
            return "Shape \"plymesh\" \"string filename\" \"" + name + "\"\n";
        };
        auto ply = [](const std::string& z) {
            return "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                   "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
                   "end_header\n0 0 " +
                   z + " 1 0 " + z + " 0 1 " + z + "\n3 0 1 2\n";
        };
        using Files = std::map<std::string, std::string>;
        const std::string sphere = "Shape \"sphere\"\n", blank = "\n",
                          meshes = head + mesh("a") + mesh("b"),
                          includes = head + include("a") + include("b");
        auto checksum_of = [](const Files& files) {
            TemporaryFolder folder;
            for (const auto& [name, bytes] : files) write_file_atomically(folder / name, bytes);
            return load_scene(folder / "s.pbrt", nullptr).files_checksum;
        };
        // Of each pair, the bytes of one file after the other are the same.
        const std::pair<Files, Files> pairs[] = {
            {{{"s.pbrt", meshes}, {"a", ply("2") + ply("3")}, {"b", ply("4")}},
             {{"s.pbrt", meshes}, {"a", ply("2")}, {"b", ply("3") + ply("4")}}},
            {{{"s.pbrt", includes}, {"a", sphere + blank}, {"b", sphere}},
             {{"s.pbrt", includes}, {"a", sphere}, {"b", blank + sphere}}}};
        for (const auto& [before, after] : pairs) {
            CHECK(checksum_of(before) != checksum_of(after));
            CHECK(checksum_of(before) == checksum_of(before));
        }
    }
}

// Films of scenes that are not the same, though their bytes are.
#include <doctest/doctest.h>

#include <map>

#include "tests/support/run_program.h"

TEST_SUITE("films of parts") {
    TEST_CASE(
        "teeth: bytes that move from one file of a scene to the next, and meshes that change "
        "places, make it another scene") {
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
        const std::string meshes = head + mesh("a.ply") + mesh("b.ply");
        const std::string includes = head + include("a.pbrt") + include("b.pbrt");
        const std::string sphere = "Shape \"sphere\"\n", blank = "\n";
        // Two versions of a scene whose bytes, one file after the other, are the same.
        for (const auto& [before, after] : std::vector<std::pair<Files, Files>>{
                 // from the end of a mesh to the start of the next one, which is read all the same
                 {{{"s.pbrt", meshes}, {"a.ply", ply("2") + ply("3")}, {"b.ply", ply("4")}},
                  {{"s.pbrt", meshes}, {"a.ply", ply("2")}, {"b.ply", ply("3") + ply("4")}}},
                 // from the end of an included file to the start of the next one
                 {{{"s.pbrt", includes}, {"a.pbrt", sphere + blank}, {"b.pbrt", sphere}},
                  {{"s.pbrt", includes}, {"a.pbrt", sphere}, {"b.pbrt", blank + sphere}}},
                 // the names of two meshes
                 {{{"s.pbrt", meshes}, {"a.ply", ply("2")}, {"b.ply", ply("3")}},
                  {{"s.pbrt", meshes}, {"a.ply", ply("3")}, {"b.ply", ply("2")}}}}) {
            TemporaryFolder folder;
            auto write = [&](const Files& files) {
                for (const auto& [name, bytes] : files) write_file_atomically(folder / name, bytes);
            };
            auto render = [&](const std::string& film, const char* seed) {
                return run(path_tracer,
                           {folder / "s.pbrt", "--size", "4x3", "--spp", "1", "--quiet", "--seed",
                            seed, "--film", folder / film, "--out", folder / "a.ppm"});
            };
            write(before);
            REQUIRE(render("a.film", "1").code == 0);
            write(after);
            const std::string why =
                ": error: a film of another scene: its files are not the same\n";
            Finished end = render("a.film", "1");
            CHECK(end.code == 1);
            CHECK(end.err == folder / "a.film" + why);
            REQUIRE(render("b.film", "2").code == 0);
            end = run("merge", {folder / "out.pfm", folder / "a.film", folder / "b.film"});
            CHECK(end.code == 1);
            CHECK(end.err == folder / "b.film" + why);
            write(before);
            CHECK(render("a.film", "1").code == 0);
        }
    }
}

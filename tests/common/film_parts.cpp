// Films by the programs: of parts, with parts missing, and by other code.
#include <doctest/doctest.h>

#include <fstream>
#include <map>

#include "common/picture/film_file.h"
#include "tests/support/run_program.h"

namespace fs = std::filesystem;

TEST_SUITE("films of parts") {
    TEST_CASE("identity: parts of an uneven render, however many, have the bytes of the whole") {
        const std::string program = "19_adaptive";
        for (auto [spp, parts] : {std::pair(6, 5), {3, 3}, {2, 2}, {9, 4}, {21, 2}}) {
            TemporaryFolder folder;
            auto render = [&, spp = spp](const std::string& name, const std::string& part) {
                return run(program, {spheres, "--size", "9x7", "--spp", std::to_string(spp),
                                     "--quiet", "--part", part, "--film", folder / name + ".film",
                                     "--out", folder / name + ".pfm"});
            };
            REQUIRE(render("whole", "1/1").code == 0);
            std::string whole = read_file(folder / "whole.film");
            Words some = {folder / "some.film"}, all = {folder / "all.film", folder / "some.film"};
            for (int part = parts; part >= 1; part--) {
                std::string name = std::to_string(part);
                REQUIRE(render(name, name + "/" + std::to_string(parts)).code == 0);
                // Each has its own samples, and goes on from them.
                std::string before = read_file(folder / name + ".film");
                CHECK(read_film(folder / name + ".film").label.samples.size() == 1);
                REQUIRE(render(name, name + "/" + std::to_string(parts)).code == 0);
                CHECK(read_file(folder / name + ".film") == before);
                (part % 2 == 0 ? all : some).push_back(folder / name + ".film");
            }
            REQUIRE(run("merge", some).code == 0);
            REQUIRE(run("merge", all).code == 0);
            CHECK(read_file(folder / "all.film") == whole);
            // And on from there.
            for (const char* film : {"all", "whole"}) {
                REQUIRE(run(program, {spheres, "--size", "9x7", "--spp", "30", "--quiet", "--film",
                                      folder / film + ".film", "--out", folder / "a.pfm"})
                            .code == 0);
            }
            CHECK(read_file(folder / "all.film") == read_file(folder / "whole.film"));
        }
    }

    TEST_CASE("truth: merge names the parts that are missing, and says when the error is unknown") {
        TemporaryFolder folder;
        for (const char* part : {"1", "2", "4"}) {
            REQUIRE(run(path_tracer, {spheres, "--size", "9x7", "--spp", "6", "--seed", "3",
                                      "--quiet", "--part", std::string(part) + "/5", "--film",
                                      folder / part + ".film", "--out", folder / "a.ppm"})
                        .code == 0);
        }
        auto merged = [&](const Words& films) {
            Words words = {folder / "out.pfm", "--stats", folder / "s.json"};
            for (const std::string& film : films) words.push_back(folder / film + ".film");
            Finished end = run("merge", words);
            CHECK(end.code == 0);
            return end.out;
        };
        auto has = [](const std::string& text, const std::string& words) {
            CAPTURE(text);
            return text.find(words) != std::string::npos;
        };
        std::string out = merged({"4", "1", "2"});
        CHECK(has(out, "\nwarning: sample 2 of seed 3 is missing: part 3/5\n"));
        CHECK(has(out, "\nwarning: samples 4 to 5 of seed 3 are missing: part 5/5\n"));
        CHECK(has(read_file(folder / "s.json"), "sample 2 of seed 3 is missing: part 3/5"));
        CHECK(has(out, " +- "));
        CHECK(has(out, "3 films  9x7  "));
        out = merged({"2"});
        CHECK(has(out, "\nwarning: samples 2 to 5 of seed 3 are missing: parts 3/5 to 5/5\n"));
        CHECK(has(out, ", standard error unknown (1 sample)\n"));
        CHECK_FALSE(has(out, "nan"));
    }

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
                 // all of it
                 {{{"s.pbrt", includes}, {"a.pbrt", sphere}, {"b.pbrt", ""}},
                  {{"s.pbrt", includes}, {"a.pbrt", ""}, {"b.pbrt", sphere}}},
                 // the names of two meshes
                 {{{"s.pbrt", meshes}, {"a.ply", ply("2")}, {"b.ply", ply("3")}},
                  {{"s.pbrt", meshes}, {"a.ply", ply("3")}, {"b.ply", ply("2")}}},
                 // a link, from one mesh to the other
                 {{{"s.pbrt", meshes + mesh("c.ply")},
                   {"a.ply", ply("2")},
                   {"b.ply", ply("3")},
                   {"c.ply", "-> a.ply"}},
                  {{"c.ply", "-> b.ply"}}}}) {
            TemporaryFolder folder;
            auto write = [&](const Files& files) {
                for (const auto& [name, bytes] : files) {
                    fs::remove(folder / name);
                    std::string target = bytes.starts_with("-> ") ? bytes.substr(3) : "";
                    if (target.empty())
                        write_file_atomically(folder / name, bytes);
                    else if (!make_link(target, folder / name))
                        fs::copy_file(folder / target, folder / name);
                }
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

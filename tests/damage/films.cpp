// Films: renders that are killed, parts by job runners, and the hashes of the code of chapters.
#include <doctest/doctest.h>

#include <fstream>
#include <map>

#include "common/picture/film_file.h"
#include "tests/support/process.h"

namespace fs = std::filesystem;

TEST_SUITE("films, slow") {
    TEST_CASE("identity: renders that are killed, and parts by job runners, lose nothing") {
        for (const char* script : {"kills", "parts"}) {
            Words words = {"bash", "tests/damage/" + std::string(script), program_folder, "30"};
            Finished end = Process(words).wait();
            CHECK(end.code == 0);
            MESSAGE(end.out);
        }
    }
}

TEST_SUITE("films of parts") {
    TEST_CASE(
        "teeth: the hash of a chapter's code changes with any file of it, and of no other "
        "chapter" *
        doctest::skip()) {
        TemporaryFolder copy, folder;
        for (const char* name : {"Makefile", "common", "chapters"})
            fs::copy(name, copy / name, fs::copy_options::recursive);
        auto hashes = [&] {
            Process make(Words{"env", "-u", "MAKEFLAGS", "-u", "MAKELEVEL", "make", "-C",
                               copy.path(), "--quiet", "-B", "BUILD=build",
                               "build/include/code_hashes.h"});
            REQUIRE(make.wait().code == 0);
            std::map<std::string, std::string> all;  // name of the chapter -> hash
            std::istringstream lines(read_file(copy / "build/include/code_hashes.h"));
            for (std::string line; std::getline(lines, line);) {
                char chapter[100], hash[100];
                if (std::sscanf(line.c_str(), " {\"%99[^\"]\", \"%99[^\"]\"}", chapter, hash) == 2)
                    all[chapter] = hash;
            }
            REQUIRE(all.size() >= 20);
            return all;
        };
        auto change = [&](const std::string& file) {
            std::ofstream(copy / file, std::ios::app) << "// more\n";
        };
        auto before = hashes();
        REQUIRE(run(path_tracer, {spheres, "--size", "3x3", "--spp", "1", "--quiet", "--film",
                                  folder / "a.film", "--out", folder / "a.ppm"})
                    .code == 0);
        CHECK(read_film(folder / "a.film").label.options[1].second == before[path_tracer]);
        change("common/tools/compare.cpp");  // in no chapter
        change("chapters/07_path_tracing/estimator.h");
        auto after = hashes();
        for (const auto& [chapter, hash] : before)
            CHECK((after[chapter] != hash) == (chapter == path_tracer));
        change("common/material/ggx.h");
        for (const auto& [chapter, hash] : hashes()) CHECK(after[chapter] != hash);
    }
}

// Films by the programs: of parts, with parts missing, and by other code.
#include <doctest/doctest.h>

#include <fstream>
#include <map>

#include "common/picture/film_file.h"
#include "tests/support/run_program.h"

namespace fs = std::filesystem;

namespace {

/// The value of an option in the label of a film.
std::string option_of(const std::string& path, const std::string& name) {
    for (const auto& [its_name, value] : read_film(path).label.options) {
        if (its_name == name) return value;
    }
    return "no option " + name;
}

/// A copy of the code, and the hashes that make finds for it: name of the chapter -> hash.
class CopyOfCode {
public:
    CopyOfCode() {
        for (const char* name : {"Makefile", "common", "chapters"}) {
            fs::copy(name, folder_ / name, fs::copy_options::recursive);
        }
    }
    std::string operator/(const std::string& name) const { return folder_ / name; }

    std::map<std::string, std::string> hashes() const {
        std::string made = "build/include/code_hashes.h";
        fs::remove(folder_ / made);
        Finished end = Process([&] {
                           ::unsetenv("MAKEFLAGS");
                           ::unsetenv("MAKELEVEL");
                           ::execlp("make", "make", "-C", folder_.path().c_str(), "--quiet",
                                    "BUILD=build", made.c_str(), nullptr);
                           return 127;
                       }).wait();
        CAPTURE(end.err);
        REQUIRE(end.code == 0);
        std::map<std::string, std::string> hashes;
        std::istringstream lines(read_file(folder_ / made));
        for (std::string line; std::getline(lines, line);) {
            char chapter[100], hash[100];
            if (std::sscanf(line.c_str(), " {\"%99[^\"]\", \"%99[^\"]\"}", chapter, hash) == 2) {
                hashes[chapter] = hash;
            }
        }
        return hashes;
    }

private:
    TemporaryFolder folder_;
};

}  // namespace

TEST_SUITE("films of parts") {
    TEST_CASE("identity: parts of an uneven render, however many, have the bytes of the whole") {
        const std::string program = "16_adaptive";
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
        out = merged({"2"});
        CHECK(has(out, "\nwarning: samples 2 to 5 of seed 3 are missing: parts 3/5 to 5/5\n"));
        CHECK(has(out, ", standard error unknown (1 sample)\n"));
        CHECK_FALSE(has(out, "nan"));
    }

    TEST_CASE(
        "teeth: the hash of a chapter's code changes with any file of it, and of no other "
        "chapter") {
        CopyOfCode copy;
        auto before = copy.hashes();
        REQUIRE(before.size() >= 20);
        TemporaryFolder folder;
        REQUIRE(run(path_tracer, {spheres, "--size", "3x3", "--spp", "1", "--quiet", "--film",
                                  folder / "a.film", "--out", folder / "a.ppm"})
                    .code == 0);
        CHECK(option_of(folder / "a.film", "code") == before[path_tracer]);

        std::ofstream(copy / "chapters/06_path_tracing/estimator.h", std::ios::app) << "// more\n";
        auto after = copy.hashes();
        for (const auto& [chapter, hash] : before) {
            CHECK((after[chapter] != hash) == (chapter == path_tracer));
        }
        std::ofstream(copy / "common/material/ggx.h", std::ios::app) << "// more\n";
        before = copy.hashes();
        for (const auto& [chapter, hash] : before) CHECK(after[chapter] != hash);
        // A tool is in no chapter.
        std::ofstream(copy / "common/tools/compare.cpp", std::ios::app) << "// more\n";
        CHECK(copy.hashes() == before);
    }
}

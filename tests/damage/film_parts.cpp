// The hashes of the code of chapters, which make finds.
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
    TEST_CASE(
        "teeth: the hash of a chapter's code changes with any file of it, and of no other "
        "chapter" *
        doctest::skip()) {
        CopyOfCode copy;
        auto before = copy.hashes();
        REQUIRE(before.size() >= 20);
        TemporaryFolder folder;
        REQUIRE(run(path_tracer, {spheres, "--size", "3x3", "--spp", "1", "--quiet", "--film",
                                  folder / "a.film", "--out", folder / "a.ppm"})
                    .code == 0);
        CHECK(option_of(folder / "a.film", "code") == before[path_tracer]);

        std::ofstream(copy / "chapters/07_path_tracing/estimator.h", std::ios::app) << "// more\n";
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

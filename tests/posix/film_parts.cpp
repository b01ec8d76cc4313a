// Films by other code of a chapter, which make compiles; and pipes instead of films.
#include <doctest/doctest.h>
#include <sys/stat.h>

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
    TEST_CASE("input: merge refuses a pipe or a device in one line, and does not wait for it") {
        TemporaryFolder folder;
        REQUIRE(::mkfifo((folder / "pipe.film").c_str(), 0600) == 0);
        fs::create_symlink(folder / "pipe.film", folder / "link.film");
        REQUIRE(run(path_tracer, {spheres, "--size", "9x7", "--spp", "1", "--quiet", "--film",
                                  folder / "a.film", "--out", folder / "a.ppm"})
                    .code == 0);
        std::string good = folder / "a.film";
        for (const std::string& bad :
             {folder / "pipe.film", folder / "link.film", std::string("/dev/null")}) {
            for (const Words& films : {Words{bad, good}, {good, bad}}) {
                Finished end =
                    Process([&] {
                        ::alarm(20);  // s: ends it where it waits
                        return execute("merge", {folder / "out.pfm", films[0], films[1]});
                    }).wait();
                CHECK(end.code == 1);
                CHECK(end.err == bad +
                                     ": error: a film must be a file: what this is cannot be read "
                                     "and replaced\n");
            }
        }
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

TEST_SUITE("films, slow") {
    TEST_CASE("teeth: a chapter that was edited and compiled again refuses its old films") {
        TemporaryFolder folder;
        // What make needs to compile one file of the chapter and the hashes, and to link.
        Finished end = Process([&] {
                           ::unsetenv("MAKEFLAGS");
                           ::unsetenv("MAKELEVEL");
                           ::setenv("program", path_tracer.c_str(), 1);
                           ::setenv("programs", program_folder.c_str(), 1);
                           ::setenv("copy", folder.path().c_str(), 1);
                           const char* script = R"bash(set -e
mkdir -p "$copy/build/obj"
cp -a Makefile common chapters "$copy"
cp -a "$programs"/{flags,packages,include} "$copy/build"
cp -a "$programs/obj/common" "$copy/build/obj"
rm -f "$copy"/build/obj/*/*/*.d
cd "$copy"
echo '// more' >>"chapters/$program/estimator.h"
make --quiet CXX="$(cut -d' ' -f1 build/flags)" CXXFLAGS="$(cut -d' ' -f2- build/flags)" \
    BUILD=build "build/$program")bash";
                           ::execlp("bash", "bash", "-c", script, nullptr);
                           return 127;
                       }).wait();
        CAPTURE(end.err);
        REQUIRE(end.code == 0);
        MESSAGE(end.out);
        std::string edited = folder / "build/" + path_tracer;
        auto words = [&](const char* film, const char* seed) {
            return Words{spheres, "--size",  "4x3",    "--spp",       "1",     "--seed",
                         seed,    "--quiet", "--film", folder / film, "--out", folder / "a.ppm"};
        };
        REQUIRE(run(path_tracer, words("a.film", "1")).code == 0);
        std::string before = read_file(folder / "a.film");
        auto render_edited = [&](const char* film, const char* seed) {
            return Process([&] {
                       std::vector<char*> argv = {edited.data()};
                       Words all = words(film, seed);
                       for (std::string& word : all) argv.push_back(word.data());
                       argv.push_back(nullptr);
                       ::execv(argv[0], argv.data());
                       return 127;
                   })
                .wait();
        };
        const std::string why = ": error: the film was made by other code of this chapter\n";
        end = render_edited("a.film", "1");
        CHECK(end.code == 1);
        CHECK(end.err == folder / "a.film" + why);
        CHECK(read_file(folder / "a.film") == before);
        REQUIRE(render_edited("b.film", "2").code == 0);
        end = run("merge", {folder / "out.pfm", folder / "a.film", folder / "b.film"});
        CHECK(end.code == 1);
        CHECK(end.err == folder / "b.film" + why);
        CHECK(render_edited("b.film", "2").code == 0);
        CHECK(run(path_tracer, words("a.film", "1")).code == 0);
    }
}

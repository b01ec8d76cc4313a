// What programs write where full disks, kills and limits are in the way.
#include <doctest/doctest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>

#include "common/picture/image.h"
#include "tests/support/process.h"

namespace fs = std::filesystem;

TEST_SUITE("outputs") {
    TEST_CASE("files: a write that fails in the middle keeps the old file, and leaves nothing") {
        TemporaryFolder folder;
        write_file_atomically(folder / "a", "the old one");
        // What a full disk does: let no file of this process grow beyond 100,000 bytes.
        Finished end =
            Process([&] {
                std::signal(SIGXFSZ, SIG_IGN);
                rlimit limit = {100000, 100000};
                ::setrlimit(RLIMIT_FSIZE, &limit);
                std::string error = error_of(
                    [&] { write_file_atomically(folder / "a", std::string(200000, 'x')); });
                return error == folder / "a: error: cannot write: File too large" ? 0 : 1;
            }).wait();
        CHECK(end.code == 0);
        CHECK(read_file(folder / "a") == "the old one");
        CHECK(folder.names() == std::set<std::string>{"a"});
    }

    TEST_CASE("files: each output is written or named, whatever happens to the others") {
        TemporaryFolder folder;
        fs::create_directory(folder / "split");
        fs::create_symlink("/dev/full", folder / "split/LDE.png");
        write_file_atomically(folder / "kept.ppm", "precious");
        ::chmod((folder / "kept.ppm").c_str(), 0444);
        Words words = {"--split", folder / "split", "--stats", folder / "no/s.json"};
        for (const char* name : {"no/a.pfm", "kept.ppm", "a.ppm"})
            append(words, {"--out", folder / name});
        if (!exists_here("/dev/full")) return;
        Finished end = run(path_tracer, brief(spheres, words));
        CAPTURE(end.err);
        CHECK(end.code == 1);
        std::istringstream lines(end.err);
        std::set<std::string> named;
        for (std::string line; std::getline(lines, line);)
            named.insert(line.substr(0, line.find(": error: cannot write: ")));
        CHECK(named == std::set<std::string>{folder / "split/LDE.png", folder / "no/s.json",
                                             folder / "no/a.pfm", folder / "kept.ppm"});
        for (const char* name : {"a.ppm", "split/LDE.pfm", "split/classes.png"})
            CHECK(read_image(folder / name).width >= 16);
    }

    TEST_CASE("files: a film has one owner at a time, also after kills, and nothing else is left") {
        TemporaryFolder folder;
        std::string film = folder / "a.film";
        auto words = [&](const char* part, const char* seconds) {
            return brief(spheres, {"--spp", "1000000", "--time", seconds, "--part", part, "--film",
                                   film, "--out", folder / "a.ppm"});
        };
        Process owner = start(path_tracer, words("1/2", "60"));
        REQUIRE(comes_to_be(film));
        const std::string why = ": error: another program is writing it\n";
        run(path_tracer, brief(spheres, {"--film", folder / "b.film", "--out", folder / "b.ppm"}));
        for (const Finished& end :
             {run(path_tracer, words("2/2", "1")), run("merge", {film, folder / "b.film"})}) {
            CHECK(end.code == 1);
            CHECK(end.err == film + why);
        }
        owner.kill(SIGKILL);
        owner.wait();
        CHECK(run(path_tracer, words("1/2", "0.1")).code == 0);
        CHECK(folder.names() == std::set<std::string>{"a.film", "a.ppm", "b.film", "b.ppm"});
    }

    TEST_CASE("input: memory that cannot be had is named") {
#if defined(__SANITIZE_ADDRESS__)
        MESSAGE("skipped: the sanitizer needs all addresses");
#else
        TemporaryFolder folder;
        Finished end = Process([&] {
                           rlimit limit = {500 << 20, 500 << 20};
                           ::setrlimit(RLIMIT_AS, &limit);
                           return execute(path_tracer, {"scenes/furnace.pbrt", "--size",
                                                        "5000x5000", "--out", folder / "a.ppm"});
                       }).wait();
        CHECK(end.code == 1);
        CHECK(end.err.starts_with("error: out of memory: a film of 5000x5000 pixels needs "));
#endif
    }
}

// What programs write where disks, pipes, kills and limits are in the way.
#include <doctest/doctest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#ifdef __linux__
#include <sched.h>
#include <sys/mount.h>
#endif

#include "common/picture/image.h"
#include "tests/support/run_program.h"

namespace fs = std::filesystem;

namespace {

/// Options for a render of a few milliseconds.
Words brief(const std::string& scene, const Words& more) {
    Words words = {scene, "--size", "16x16", "--spp", "2", "--max-depth", "3", "--quiet"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

}  // namespace

TEST_SUITE("outputs") {
#ifdef __linux__
    TEST_CASE("files: a full disk is refused before rendering, and loses no output elsewhere") {
        TemporaryFolder folder;
        std::string elsewhere = folder / "a.ppm", disk = folder / "disk";
        fs::create_directory(disk);
        // A film of 10 x 10 pixels has 11 kB, and two are there when it is saved again.
        for (auto [size, code] : {std::pair("size=20k", 1), {"size=64k", 0}, {"size=4k", 1}}) {
            bool is_film = code == 0 || std::string(size) == "size=20k";
            std::string file = disk + (is_film ? "/a.film" : "/a.png");
            Words words = {spheres, "--size",  "10x10",
                           "--spp", "4",       "--quiet",
                           "--out", elsewhere, is_film ? "--film" : "--out",
                           file};
            if (!is_film) append(words, {"--size", "200x200"});
            Finished end =
                Process([&, size = size] {
                    bool own = ::unshare(CLONE_NEWNS) == 0 &&
                               ::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0 &&
                               ::mount("none", disk.c_str(), "tmpfs", 0, size) == 0;
                    return own ? execute(path_tracer, words) : 77;
                }).wait();
            if (end.code == 77) {
                MESSAGE("skipped: no mounts of one's own here");
                return;
            }
            CHECK(end.code == code);
            CHECK(end.err.starts_with(file + ": error: ") == (code == 1));
            CHECK(fs::exists(elsewhere) == !(is_film && code == 1));
            fs::remove(elsewhere);
        }
    }
#endif

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

    TEST_CASE("truth: threads that cannot be had are done without; memory that cannot is named") {
#if defined(__SANITIZE_ADDRESS__)
        MESSAGE("skipped: the sanitizer needs all addresses");
#else
        TemporaryFolder folder;
        auto with_memory = [&](rlim_t mb, const Words& words) {
            return Process([&] {
                       rlimit limit = {mb << 20, mb << 20};
                       ::setrlimit(RLIMIT_AS, &limit);
                       return execute(path_tracer, words);
                   })
                .wait();
        };
        Finished end = with_memory(500, {"scenes/furnace.pbrt", "--size", "5000x5000", "--quiet",
                                         "--out", folder / "a.ppm"});
        CHECK(end.code == 1);
        CHECK(end.err.starts_with("error: out of memory: a film of 5000x5000 pixels needs "));
        CHECK(end.err.ends_with(" MB\n"));

        // Of so many triangles that threads build the hierarchy; each wants a stack of 8 MB.
        Words words = brief("scenes/knot.pbrt", {"--threads", "16", "--out", folder / "a.ppm"});
        int rendered = 0;
        for (rlim_t mb = 20; mb <= 400; mb += 20) {
            end = with_memory(mb, words);
            CAPTURE(mb);
            CAPTURE(end.err);
            rendered += end.code == 0;
            bool is_named = end.code == 1 && end.err.find("out of memory") != std::string::npos;
            CHECK((end.code == 0 || is_named || end.code == 127));  // 127: libraries need more
        }
        CHECK(rendered > 5);
#endif
    }
}

TEST_SUITE("programs") {
    TEST_CASE("files: from any folder the default scene is found, and out/ is made there") {
        TemporaryFolder folder;
        std::string program = fs::absolute(program_file(path_tracer)).string();
        fs::create_symlink(program, folder / "linked");
        auto run_in = [&](const std::string& place, const std::string& command) {
            return Process([&] {
                       fs::current_path(place);
                       std::string path = fs::path(program).parent_path().string() + ":/bin";
                       ::setenv("PATH", path.c_str(), 1);
                       std::string options = " --size 9x9 --spp 1 --max-depth 1";
                       ::execl("/bin/sh", "sh", "-c", (command + options).c_str(), nullptr);
                       return 127;
                   })
                .wait();
        };
        for (const std::string& command : {program, path_tracer, std::string("./linked")}) {
            CAPTURE(command);
            Finished end = run_in(folder.path(), command);
            CHECK(end.code == 0);
            CHECK(end.err == "");
            CHECK(end.out.find("/scenes/cornell.pbrt  9x9  1 spp\n") != std::string::npos);
            CHECK(read_image(folder / "out/07_path_tracing.ppm").width == 9);
            fs::remove_all(folder / "out");
        }
    }
}

// What programs write where modes, mounts, pipes and limits are in the way.
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

#ifdef __linux__
/// Runs `work` in a process whose mounts are its own, if that may be.
template <typename Work>
Finished with_own_mounts(const Work& work) {
    return Process([&] {
               bool own = ::unshare(CLONE_NEWNS) == 0 &&
                          ::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0;
               return own ? work() : 77;
           })
        .wait();
}
#endif

}  // namespace

TEST_SUITE("outputs") {
#ifdef __linux__
    TEST_CASE("files: a full disk is refused before rendering, and loses no output elsewhere") {
        TemporaryFolder folder;
        std::string elsewhere = folder / "a.ppm", disk = folder / "disk";
        fs::create_directory(disk);
        // A film of 10 x 10 pixels has 11 kB, and two are there when it is saved again.
        for (const char* size : {"size=20k", "size=64k"}) {
            Finished end = with_own_mounts([&] {
                ::mount("none", disk.c_str(), "tmpfs", 0, size);
                return execute(path_tracer, {spheres, "--size", "10x10", "--spp", "4", "--quiet",
                                             "--film", disk + "/a.film", "--out", elsewhere});
            });
            if (end.code == 77) {
                MESSAGE("skipped: no mounts of one's own here");
                return;
            }
            bool has_room = size == std::string("size=64k");
            CHECK(end.code == (has_room ? 0 : 1));
            CHECK(end.err.starts_with(disk + "/a.film: error: ") == !has_room);
        }
        Finished end = with_own_mounts([&] {
            ::mount("none", disk.c_str(), "tmpfs", 0, "size=4k");
            return execute(path_tracer, brief(spheres, {"--out", disk + "/a.pfm", "--out",
                                                        disk + "/b.pfm", "--out", elsewhere}));
        });
        CHECK(end.code == 1);
        CHECK(end.err.find(disk + "/b.pfm: error: cannot write: ") != std::string::npos);
        CHECK(read_image(elsewhere).width == 16);
    }
#endif

    TEST_CASE("files: a signal while results are written loses none of them") {
        for (int signal : {SIGINT, SIGTERM, SIGHUP}) {
            TemporaryFolder folder;
            std::string pipe = folder / "pipe.ppm";
            REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
            // The film is written first; then it waits until somebody reads the pipe.
            Words words = {"--film", folder / "a.film", "--out",   pipe,
                           "--out",  folder / "a.pfm",  "--stats", folder / "s.json"};
            Process process = start(path_tracer, brief(spheres, words));
            REQUIRE(comes_to_be(folder / "a.film"));
            ::usleep(50'000);
            process.kill(signal);
            process.kill(signal);  // as timeout does
            ::usleep(50'000);
            std::string picture = read_file(pipe);
            CHECK(picture.size() - picture.find("\n255\n") == 5 + 16 * 16 * 3);
            Finished end = process.wait();
            CHECK(end.code == 0);
            CHECK(read_image(folder / "a.pfm").width == 16);
            CHECK(read_file(folder / "s.json").find("\"interrupted\": false") != std::string::npos);
        }
    }

    TEST_CASE("files: each output is written or named, whatever happens to the others") {
        TemporaryFolder folder;
        int ends[2];
        REQUIRE(::pipe(ends) == 0);
        fs::create_symlink("/dev/fd/" + std::to_string(ends[1]), folder / "gone.ppm");
        fs::create_directory(folder / "split");
        fs::create_symlink("/dev/full", folder / "split/LDE.png");
        write_file_atomically(folder / "kept.ppm", "precious");
        ::chmod((folder / "kept.ppm").c_str(), 0444);
        Words outputs = {"--split", folder / "split", "--stats", folder / "no/s.json"};
        std::set<std::string> lost = {folder / "split/LDE.png", folder / "no/s.json"};
        for (const char* name : {"no/a.pfm", "kept.ppm", "gone.ppm"}) {
            append(outputs, {"--out", folder / name});
            lost.insert(folder / name);
        }
        append(outputs, {"--out", folder / "a.ppm"});
        if (!exists_here("/dev/full") || !exists_here("/dev/fd/0")) return;
        ::close(ends[0]);
        Finished end = run(path_tracer, brief(spheres, outputs));
        ::close(ends[1]);
        CAPTURE(end.err);
        CHECK(end.code == 1);
        std::istringstream lines(end.err);
        std::set<std::string> named;
        for (std::string line; std::getline(lines, line);)
            named.insert(line.substr(0, line.find(": error: cannot write: ")));
        CHECK(named == lost);
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
        for (int tries = 0; tries < 3; tries++) {  // also when the film has been replaced
            Finished end = run(path_tracer, words("2/2", "1"));
            CHECK(end.code == 1);
            CHECK(end.err == film + why);
        }
        run(path_tracer, brief(spheres, {"--film", folder / "b.film", "--out", folder / "b.ppm"}));
        Finished end = run("merge", {film, folder / "b.film"});
        CHECK(end.code == 1);
        CHECK(end.err == film + why);
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
        auto with_limit = [&](int kind, rlim_t most, const Words& words) {
            return Process([&] {
                       rlimit limit = {most, most};
                       ::setrlimit(kind, &limit);
                       return execute(path_tracer, words);
                   })
                .wait();
        };
        Finished end = with_limit(
            RLIMIT_AS, 500 << 20,
            {"scenes/furnace.pbrt", "--size", "5000x5000", "--quiet", "--out", folder / "a.ppm"});
        CHECK(end.code == 1);
        CHECK(end.err.starts_with("error: out of memory: a film of 5000x5000 pixels needs "));
        CHECK(end.err.ends_with(" MB\n"));

        // Of so many triangles that threads build the hierarchy; each wants a stack of 8 MB.
        Words words = brief("scenes/knot.pbrt", {"--threads", "16", "--out", folder / "a.ppm"});
        int rendered = 0;
        for (int mb = 20; mb <= 400; mb += 20) {
            end = with_limit(RLIMIT_AS, static_cast<rlim_t>(mb) << 20, words);
            CAPTURE(mb);
            CAPTURE(end.err);
            rendered += end.code == 0;
            bool is_named = end.code == 1 && end.err.find("out of memory") != std::string::npos;
            CHECK((end.code == 0 || is_named || end.code == 127));  // 127: libraries need more
        }
        CHECK(rendered > 5);
        CHECK(with_limit(RLIMIT_STACK, 64 << 10, words).err ==
              "error: out of memory: the stack needs 0.131 MB\n");
#endif
    }
}

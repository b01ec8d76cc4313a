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

bool comes_to_be(const std::string& path) {
    for (int i = 0; i < 20000 && !fs::exists(path); i++) ::usleep(1000);
    return fs::exists(path);
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
    TEST_CASE("files: a file that is mounted, and a full disk, are refused before rendering") {
        TemporaryFolder folder;
        std::string busy = folder / "busy.ppm", disk = folder / "disk";
        write_file_atomically(busy, "mounted");
        fs::create_directory(disk);
        Finished end = with_own_mounts([&] {
            ::mount(busy.c_str(), busy.c_str(), nullptr, MS_BIND, nullptr);
            return execute(path_tracer, {spheres, "--spp", "100000000", "--out", busy});
        });
        if (end.code == 77) {
            MESSAGE("skipped: no mounts of one's own here");
            return;
        }
        CHECK(end.code == 1);
        CHECK(end.err.ends_with(busy + ": error: cannot write: Device or resource busy\n"));
        CHECK(folder.names() == std::set<std::string>{"busy.ppm", "disk"});

        end = with_own_mounts([&] {
            ::mount("none", disk.c_str(), "tmpfs", 0, "size=1m");
            return execute(path_tracer, {spheres, "--size", "256x256", "--spp", "100000000",
                                         "--out", disk + "/a.pfm", "--out", disk + "/b.pfm"});
        });
        CHECK(end.code == 1);
        CHECK(end.err.ends_with(
            disk +
            "/b.pfm: error: cannot write: No space left on device: what is to be written "
            "there needs 1.57 MB, 1.05 MB are free\n"));
    }
#endif

    TEST_CASE("files: a read-only folder says so, also that of out/ and --split") {
        TemporaryFolder folder;
        std::string program = fs::absolute(program_file(path_tracer)).string();
        std::string scene = fs::absolute(spheres).string();
        fs::copy_file(program, folder / "program");
        fs::copy_file(scene, folder / "a.pbrt");
        ::chmod(folder.path().c_str(), 0555);
        auto run_there = [&](const std::string& words) {
            return Process([&] {
                       if (::getuid() == 0 && ::setuid(65534) != 0) return 2;
                       fs::current_path(folder.path());
                       std::string command = "exec ./program a.pbrt --quiet --spp 1 " + words;
                       ::execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
                       return 127;
                   })
                .wait();
        };
        const std::string why = ": error: cannot make the folder: Permission denied\n";
        Finished end = run_there("");
        CHECK(end.code == 1);
        CHECK(end.err == "out" + why);
        end = run_there("--split d --out a.ppm");
        CHECK(end.err == "d" + why);
        end = run_there("--out a.ppm");
        CHECK(end.err == "a.ppm: error: cannot write: Permission denied\n");
        ::chmod(folder.path().c_str(), 0755);
    }

    TEST_CASE("input: a pipe or a device as film, and a film at every moment, end with a message") {
        TemporaryFolder folder;
        std::string film = folder / "a.film", out = folder / "a.ppm";
        REQUIRE(::mkfifo(film.c_str(), 0600) == 0);
        fs::create_symlink("/dev/null", folder / "b.film");
        for (const std::string& name : {film, folder / "b.film"}) {
            Finished end = run(path_tracer, brief(spheres, {"--film", name, "--out", out}));
            CHECK(end.code == 1);
            CHECK(end.err == name +
                                 ": error: a film must be a file: what this is cannot be read "
                                 "and replaced\n");
        }
        for (const char* seconds : {"1e-9", "0.009", "0"}) {
            Words words = {"--film", folder / "c.film", "--film-every", seconds, "--out", out};
            Finished end = run(path_tracer, brief(spheres, words));
            CHECK(end.code == 2);
            CHECK(end.err.starts_with("error: --film-every takes "));
        }
        Words words = {"--film", folder / "c.film", "--film-every", "0.01", "--out", out};
        CHECK(run(path_tracer, brief(spheres, words)).code == 0);
    }

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

    TEST_CASE("files: a file that may not grow, or a reader that has gone, loses no other result") {
        TemporaryFolder folder;
        Words words = brief(spheres, {"--out", folder / "large.pfm", "--out", folder / "a.ppm"});
        Finished end = Process([&] {
                           rlimit limit = {2000, 2000};
                           ::setrlimit(RLIMIT_FSIZE, &limit);
                           return execute(path_tracer, words);
                       }).wait();
        CHECK(end.code == 1);
        CHECK(end.err == folder / "large.pfm" + ": error: cannot write: File too large\n");
        CHECK(folder.names() == std::set<std::string>{"a.ppm"});

        int ends[2];
        REQUIRE(::pipe(ends) == 0);
        words = brief(spheres, {"--out", folder / "gone.ppm", "--out", folder / "b.ppm"});
        fs::create_symlink("/dev/fd/" + std::to_string(ends[1]), folder / "gone.ppm");
        if (!exists_here("/dev/fd/0")) return;
        ::close(ends[0]);
        end = start(path_tracer, words).wait();
        ::close(ends[1]);
        CHECK(end.code == 1);
        CHECK(end.err == folder / "gone.ppm" + ": error: cannot write: Broken pipe\n");
        CHECK(read_image(folder / "b.ppm").width == 16);
    }

    TEST_CASE("truth: what does not fit into memory is named with its size") {
#if defined(__SANITIZE_ADDRESS__)
        MESSAGE("skipped: the sanitizer needs all addresses");
#else
        TemporaryFolder folder;
        Finished end =
            Process([&] {
                rlimit limit = {500 << 20, 500 << 20};
                ::setrlimit(RLIMIT_AS, &limit);
                return execute(path_tracer, {"scenes/furnace.pbrt", "--size", "5000x5000",
                                             "--quiet", "--out", folder / "a.ppm"});
            }).wait();
        CHECK(end.code == 1);
        CHECK(end.err.starts_with("error: out of memory: a film of 5000x5000 pixels needs "));
        CHECK(end.err.ends_with(" MB\n"));
#endif
    }

    TEST_CASE("teeth: the name of a folder runs no code in make compile_commands.json") {
        TemporaryFolder folder;
        std::string place = folder / "it's;touch pwned;'\"\\x", project = fs::current_path();
        fs::create_directory(place);
        for (const char* name : {"Makefile", "common", "chapters", "tests", "scenes"})
            fs::create_symlink(fs::path(project) / name, fs::path(place) / name);
        Finished end = Process([&] {
                           fs::current_path(place);
                           ::unsetenv("MAKEFLAGS"), ::unsetenv("PWD");
                           ::execlp("make", "make", "BUILD=b", "compile_commands.json", nullptr);
                           return 127;
                       }).wait();
        CHECK(end.code == 0);
        CHECK_FALSE(fs::exists(place + "/pwned"));
        std::string json = read_file(place + "/compile_commands.json");
        CHECK(json.find("/it's;touch pwned;'\\\"\\\\x\", \"file\": \"chapters/") !=
              std::string::npos);
        CHECK(json.find("command not found") == std::string::npos);
    }

    TEST_CASE("teeth: render_parts hands on names with braces as they are") {
        TemporaryFolder folder;
        if (std::system("command -v parallel >/dev/null") != 0) {
            MESSAGE("skipped: GNU parallel is not installed");
            return;
        }
        // A program, and a merge beside it, that write down their words.
        write_file_atomically(folder / "program",
                              "#!/bin/sh\nprintf '<%s>' \"$@\" >>\"$0.words\"\n");
        ::chmod((folder / "program").c_str(), 0755);
        fs::copy_file(folder / "program", folder / "merge");
        std::string out = folder / "a{}{1}{=1=}.film", scene = "{} it's {.}.pbrt";
        Finished end = Process([&] {
                           ::execlp("bash", "bash", "common/tools/render_parts", "1", out.c_str(),
                                    (folder / "program").c_str(), scene.c_str(), nullptr);
                           return 127;
                       }).wait();
        CHECK(end.code == 0);
        CHECK(read_file(folder / "program.words") == "<" + scene +
                                                         "><--quiet><--part><1/1><--film><" + out +
                                                         "-1.film><--out><" + out + "-1.ppm>");
        CHECK(read_file(folder / "merge.words") == "<" + out + "><" + out + "-1.film>");
    }
}

// What programs write: never over what they read, whole after a signal, and with a word where it
// cannot be done.
#include <doctest/doctest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#ifdef __linux__
#include <sched.h>
#include <sys/mount.h>
#endif

#include <chrono>

#include "common/picture/image.h"
#include "tests/support/run_program.h"

namespace fs = std::filesystem;

namespace {

const std::string overwritten = ", and would be overwritten\n";

/// A room of mirrors, in which a path of chapter 07 hardly ends.
const char* mirrors = R"(
LookAt 0 0 0  0 0.3 1  0 1 0
Camera "perspective"
Integrator "path" "integer maxdepth" 1000000000
WorldBegin
Material "conductor" "rgb reflectance" [1 1 1]
Shape "sphere" "float radius" 2
AttributeBegin
Material "diffuse"
AreaLightSource "diffuse"
Translate 0 -1.5 0
Shape "sphere" "float radius" 0.1
AttributeEnd
)";

/// Options for a render of a few milliseconds.
Words brief(const std::string& scene, const Words& more) {
    Words words = {scene, "--size", "16x16", "--spp", "2", "--max-depth", "3", "--quiet"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

double seconds_since(std::chrono::steady_clock::time_point begin) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// A run that gets SIGTERM soon after it has begun to render.
Finished stopped(const std::string& program, const Words& words) {
    for (int ms = 200;; ms *= 2) {  // longer where it was loading still
        Process process = start(program, words);
        ::usleep(static_cast<useconds_t>(1000 * ms));
        process.kill(SIGTERM);
        Finished end = process.wait();
        if (end.signal == 0 || ms > 10000) return end;
    }
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
    TEST_CASE("files: no output overwrites a file that the scene was read from") {
        TemporaryFolder folder;
        write_file_atomically(folder / "a.pbrt",
                              "Camera \"perspective\"\nWorldBegin\nInclude \"part.txt\"\n"
                              "LightSource \"infinite\" \"string filename\" \"sky.pfm\"\n");
        write_file_atomically(folder / "part.txt",
                              "Shape \"plymesh\" \"string filename\" \"mesh.ply\"\n");
        write_file_atomically(folder / "mesh.ply",
                              "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                              "property float y\nproperty float z\nelement face 1\n"
                              "property list uchar int vertex_indices\nend_header\n"
                              "0 0 3\n1 0 3\n0 1 3\n3 0 1 2\n");
        Image sky(4, 4);
        for (Rgb& p : sky.pixels) p = {1, 1, 1};
        write_image(folder / "sky.pfm", sky, "");
        fs::create_symlink("sky.pfm", folder / "link.pfm");
        fs::copy_file(folder / "a.pbrt", folder / "a.svg");
        fs::create_directory(folder / "d");
        fs::create_symlink("../sky.pfm", folder / "d/LDE.pfm");
        auto refuses = [&](const std::string& scene, const Words& words) {
            CAPTURE(words[0] + " " + words[1]);
            Finished end = run("17_sky_image", brief(folder / scene, words));
            CHECK(end.code == 2);
            CHECK(end.out == "");
            CHECK(end.err.ends_with(overwritten));
        };
        std::set<std::string> before = folder.names();
        std::string out = folder / "o.ppm";
        refuses("a.pbrt", {"--out", folder / "sky.pfm"});
        refuses("a.pbrt", {"--out", folder / "link.pfm"});
        refuses("a.pbrt", {"--out", folder / "d/../sky.pfm"});
        refuses("a.pbrt", {"--stats", folder / "mesh.ply", "--out", out});
        refuses("a.pbrt", {"--stats", folder / "part.txt", "--out", out});
        refuses("a.pbrt", {"--stats", folder / "a.pbrt", "--out", out});
        refuses("a.pbrt", {"--split", folder / "d", "--out", out});
        refuses("a.svg", {"--explain", "1,1", "--out", folder / "a.ppm"});
        refuses("a.svg", {"--explain-brightest", "--out", folder / "a.ppm"});
        CHECK(folder.names() == before);
        CHECK(read_image(folder / "sky.pfm").at(1, 1) == Rgb{1, 1, 1});
        CHECK(run("17_sky_image", brief(folder / "a.pbrt", {"--out", out})).code == 0);
    }

    TEST_CASE("files: two outputs of one run are never one file, those of --split among them") {
        TemporaryFolder folder;
        for (const char* name : {"LDE.pfm", "LSDE.png", "longer.pfm", "classes.png"}) {
            for (std::string out : {folder / "d/" + name, folder / "d/../d/" + name}) {
                Finished end =
                    run(path_tracer, brief(spheres, {"--split", folder / "d", "--out", out}));
                CHECK(end.code == 2);
                CHECK(end.err.ends_with(" are one file\n"));
            }
        }
        Words other = {"--split", folder / "d", "--out", folder / "d/picture.pfm"};
        CHECK(run(path_tracer, brief(spheres, other)).code == 0);
        CHECK(fs::exists(folder / "d/picture.pfm"));
        Words map = {"--map", folder / "a.ppm", "--out", folder / "a.ppm"};
        CHECK(run("19_adaptive", brief(spheres, map)).err.ends_with(" are one file\n"));
    }

    TEST_CASE("files: compare and merge do not overwrite what they read") {
        TemporaryFolder folder;
        Image a(4, 4), b(4, 4);
        b.at(1, 1) = {1, 1, 1};
        write_image(folder / "a.pfm", a, "");
        write_image(folder / "b.pfm", b, "");
        write_image(folder / "b.err.pfm", a, "");
        for (const char* out : {"a.pfm", "./b.pfm", "b.err.pfm"}) {
            std::string before = read_file(folder / out);
            Finished end =
                run("compare", {folder / "a.pfm", folder / "b.pfm", "--out", folder / out});
            CHECK(end.code == 2);
            CHECK(end.err.ends_with(overwritten));
            CHECK(read_file(folder / out) == before);
        }
        Finished end = run("merge", {folder / "a.film", folder / "b.film", folder / "./a.film"});
        CHECK(end.code == 2);
        CHECK(end.err.ends_with(overwritten));
    }

    TEST_CASE("files: a write-protected result is refused before rendering, in each chapter") {
        TemporaryFolder folder;
        std::string out = folder / "a.ppm";
        write_file_atomically(out, "precious");
        ::chmod(out.c_str(), 0444);
        for (const std::string& program : programs(true)) {
            CAPTURE(program);
            Finished end = run(program, {spheres, "--spp", "100000000", "--out", out});
            CHECK(end.code == 1);
            CHECK(end.err == out + ": error: cannot write: it is write-protected\n");
        }
        CHECK(read_file(out) == "precious");
        CHECK(folder.names() == std::set<std::string>{"a.ppm"});
    }

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

    TEST_CASE("truth: a large picture is announced before it is written") {
        TemporaryFolder folder;
        std::string out = folder / "a.ppm";
        Words words = {"scenes/furnace.pbrt", "--size", "1024x1024", "--spp", "1", "--out", out};
        CHECK(run(path_tracer, words).err == "writing " + out + "\n");
        words.push_back("--quiet");
        CHECK(run(path_tracer, words).err == "");
    }

    TEST_CASE("truth: --time ends chapters 05 and 07 in a room of mirrors, and so does a signal") {
        TemporaryFolder folder;
        write_file_atomically(folder / "m.pbrt", mirrors);
        for (const std::string program : {"05_ray_casting", "07_path_tracing"}) {
            Words words = {folder / "m.pbrt", "--size", "64x64",         "--spp", "1000",
                           "--quiet",         "--out",  folder / "a.ppm"};
            CHECK(stopped(program, words).code == 3);
            auto begin = std::chrono::steady_clock::now();
            words.insert(words.end(), {"--time", "0.3"});
            CHECK(run(program, words).code == 0);
            CHECK(seconds_since(begin) < 5);
            CHECK(read_image(folder / "a.ppm").width == 64);
        }
        // The path that is explained is told up to where it was stopped.
        Words words = {folder / "m.pbrt", "--explain", "3,3", "--quiet", "--out", folder / "a.ppm"};
        Finished end = stopped("07_path_tracing", words);
        CHECK(end.code == 3);
        CHECK(end.out.find("\n    given up here: ") != std::string::npos);
        CHECK(read_file(folder / "a.svg").ends_with("</svg>\n"));
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

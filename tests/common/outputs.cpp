// What programs write: never over what they read, whole after a signal, and with a word where it
// cannot be done.
#include <doctest/doctest.h>
#include <sys/stat.h>

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
        fs::copy_file(folder / "a.pbrt", folder / "a.svg");
        fs::create_directory(folder / "d");
        if (!make_link("../sky.pfm", folder / "d/LDE.pfm"))
            fs::create_hard_link(folder / "sky.pfm", folder / "d/LDE.pfm");
        bool has_links = make_link("sky.pfm", folder / "link.pfm");
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
        if (has_links) refuses("a.pbrt", {"--out", folder / "link.pfm"});
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
            for (const std::string& out : {folder / "d/" + name, folder / "d/../d/" + name}) {
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
}

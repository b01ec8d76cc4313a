// What programs write: never over what they read, whole after a signal, and with a word where it
// cannot be done.
#include <doctest/doctest.h>
#include <sys/stat.h>

#include "common/picture/image.h"
#include "tests/support/run_program.h"

namespace fs = std::filesystem;

namespace {

const std::string overwritten = ", and would be overwritten\n";

/// Options for a render of a few milliseconds.
Words brief(const std::string& scene, const Words& more) {
    Words words = {scene, "--size", "16x16", "--spp", "2", "--max-depth", "3", "--quiet"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
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
}

// What programs write: never over what they read, and under names in any language.
#include <doctest/doctest.h>

#include "common/picture/image.h"
#include "tests/support/process.h"

namespace fs = std::filesystem;

namespace {

const std::string overwritten = ", and would be overwritten\n", strange = "Größe 日本 🎨";

}  // namespace

TEST_SUITE("outputs") {
    TEST_CASE("files: no output overwrites a file that was read, under a name in any language") {
        TemporaryFolder folder;
        const std::string scene = folder / strange + ".pbrt", mesh = folder / strange + ".ply";
        write_file_atomically(scene,
                              "Camera \"perspective\"\nWorldBegin\nInclude \"part.txt\"\n"
                              "LightSource \"infinite\" \"string filename\" \"sky.pfm\"\n");
        write_file_atomically(folder / "part.txt",
                              "Shape \"plymesh\" \"string filename\" \"" + strange + ".ply\"\n");
        write_file_atomically(mesh,
                              "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                              "property float y\nproperty float z\nelement face 1\n"
                              "property list uchar int vertex_indices\nend_header\n"
                              "0 0 3\n1 0 3\n0 1 3\n3 0 1 2\n");
        Image sky(4, 4);
        for (Rgb& p : sky.pixels) p = {1, 1, 1};
        write_image(folder / "sky.pfm", sky, "");
        fs::copy_file(file_path(scene), folder / "a.svg");
        fs::create_directory(folder / "d");
        if (!make_link("../sky.pfm", folder / "d/classes.png"))
            fs::create_hard_link(folder / "sky.pfm", folder / "d/classes.png");
        std::string out = folder / strange + ".pfm";
        auto refuses = [&](const std::string& path, const Words& words) {
            CAPTURE(words[0] + " " + words[1]);
            Finished end = run("17_sky_image", brief(path, words));
            CHECK(end.code == 2);
            CHECK(end.out == "");
            CHECK(end.err.ends_with(overwritten));
        };
        std::set<std::string> before = folder.names();
        refuses(scene, {"--out", folder / "d/../sky.pfm"});
        for (const std::string& input : {mesh, folder / "part.txt", scene})
            refuses(scene, {"--stats", input, "--out", out});
        refuses(scene, {"--split", folder / "d", "--out", out});
        refuses(folder / "a.svg", {"--explain", "1,1", "--out", folder / "a.ppm"});
        CHECK(folder.names() == before);
        CHECK(read_image(folder / "sky.pfm").at(1, 1) == Rgb{1, 1, 1});
        Words words = brief(scene, {"--out", out, "--film", folder / strange + ".film"});
        for (int times = 0; times < 2; times++) {
            Finished end = run("17_sky_image", words);
            CHECK(end.code == 0);
            CHECK(end.err == "");
        }
        CHECK(read_image(out).width == 16);
    }
}

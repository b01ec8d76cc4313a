// Names of files as each system has them, and files that are open elsewhere.
#include <doctest/doctest.h>

#include "common/picture/image.h"
#include "tests/support/run_program.h"

namespace fs = std::filesystem;

namespace {

const std::string
    strange = "Größe 日本 🎨",
    triangle =
        "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
        "property list uchar int vertex_indices\nend_header\n";

}  // namespace

TEST_SUITE("names") {
    TEST_CASE("files: programs take names in any language, and a scene finds its files by them") {
        TemporaryFolder folder;
        std::string scene = folder / strange + ".pbrt", out = folder / strange + ".pfm";
        write_file_atomically(folder / strange + ".ply",
                              "ply\nformat ascii 1.0\n" + triangle + "0 0 3 1 0 3 0 1 3 3 0 1 2\n");
        write_file_atomically(
            scene,
            "PixelFilter \"box\" Camera \"perspective\"\nWorldBegin\nLightSource \"infinite\"\n"
            "Shape \"plymesh\" \"string filename\" \"" +
                strange + ".ply\"\n");
        Words words = {scene,   "--size", "9x7",
                       "--spp", "1",      "--out",
                       out,     "--film", folder / strange + ".film"};
        for (int times = 0; times < 2; times++) {
            Finished end = run(path_tracer, words);
            CHECK(end.code == 0);
            CHECK(end.err == "");
            CHECK(end.out.find(strange) != std::string::npos);
        }
        CHECK(read_image(out).width == 9);
        words[0] = folder / strange + ".none";
        CHECK(run(path_tracer, words).err ==
              words[0] + ": error: cannot read: No such file or directory\n");
    }

    TEST_CASE("files: what is being written is not removed, what was left over is") {
        TemporaryFolder folder;
        write_file_atomically(folder / "f.part-abcdefghijkl", "of a run that was killed");
        {
            NewFile file(folder / "f");
            file.write("half of i");
            CHECK(folder.names().size() == 1);
            check_writable(folder / "f");
            write_file_atomically(folder / "f", "by another");
            CHECK(folder.names().size() == 2);
            file.write("t");
            file.commit();
        }
        CHECK(read_file(folder / "f") == "half of it");
        CHECK(folder.names() == std::set<std::string>{"f"});
    }
}

// make race, with programs that pretend to be other renderers.
#include <doctest/doctest.h>

#include "tests/support/process.h"

namespace fs = std::filesystem;

namespace {

/// A race on cornell at 8x8 with a "pbrt" that is chapter 08 with these options.
Finished race_with(const std::string& options) {
    TemporaryFolder folder;
    for (const char* chapter :
         {"08_russian_roulette", "15_mis_ris", "16_lens_and_shutter", "20_light_tracing",
          "22_fast_bidirectional", "24_progressive_photons", "25_vertex_merging"})
        fs::create_symlink(fs::absolute(program_file(chapter)), folder / chapter);
    write_file_atomically(
        folder / "pbrt",
        "#!/bin/sh\n# --outfile FILE --nthreads N --spp N SCENE\n"
        "seed=$(sed -n 's/.*integer seed. .\\([0-9]*\\).*/\\1/p' \"$7\")\n" +
            (folder / "08_russian_roulette") +
            " \"$7\" --out \"$2\" --threads \"$4\" --spp \"$6\" --seed \"$seed\" " + options +
            "\n");
    fs::permissions(folder / "pbrt", fs::perms::owner_all);
    return Process(
               {"/bin/sh", "-c",
                "exec tests/race/race \"$0\" cornell --peers pbrt --pbrt \"$0/pbrt\" --size 8x8 "
                "--threads 1 --seconds 0.05 --reference 0.2 --turns 2 2>&1",
                folder.path()})
        .wait();
}

}  // namespace

TEST_SUITE("race") {
    TEST_CASE("agreement: a renderer that is a chapter gets a number, and none with short paths" *
              doctest::skip()) {
        if (!exists_here("/usr/bin/python3") || std::getenv("RUN") != nullptr) return;
        for (auto [options, last] : {std::pair{"--spp 4000", ") |\n"},  // "times as much (15) |"
                                     {"--max-depth 1 --spp 1000", " | - |\n"}}) {
            Finished end = race_with(options);
            CAPTURE(end.out);
            CHECK(end.code == 0);
            CHECK(end.out.find("| scene | 16 | 20 | 22 | 24 | 25 | pbrt | best / pbrt |\n") !=
                  std::string::npos);
            bool other = end.out.find(" | other mean: 0.") != std::string::npos;
            CHECK(other == end.out.ends_with(" | - |\n"));
            CHECK(end.out.ends_with(last));
        }
    }

    TEST_CASE("input: scenes are told to other renderers, or refused for what is not translated") {
        Finished told = run("flatten", {"scenes/sds.pbrt"});
        CHECK(told.code == 0);
        for (const char* line : {R"({"type": "area", "L": [3200,3000,2600], "two_sided": false})",
                                 R"({"c": [-0.5,0.75,-0.200000003], "r": 0.400000006, "shape": 3})",
                                 R"("reflectance": [0.300000012,0.449999988,0.600000024])"})
            CHECK(told.out.find(line) != std::string::npos);
        for (auto [scene, what] : {std::pair{"globe", "a texture"},
                                   {"sky", "the image of a sky"},
                                   {"moving-ball", "a shape that moves"},
                                   {"near-disk", "a disk"},
                                   {"high-contrast", "a light without a size"},
                                   {"prism", "glass that disperses"},
                                   {"zone-plate", "a frame of the camera"}}) {
            std::string path = std::string("scenes/") + scene + ".pbrt";
            Finished refused = run("flatten", {path});
            CHECK(refused.code == 1);
            CHECK(refused.err == path + ": not translated: " + what + "\n");
        }
    }
}

// Chapter 26 where files may not grow.
#include <doctest/doctest.h>
#include <sys/resource.h>

#include "tests/support/run_program.h"

TEST_SUITE("ch26 program") {
    TEST_CASE("files: one output of radiosity that fails does not lose the others") {
        // Files that are too large for the limit fail: film and mesh have 14 and 26 kB or more, a
        // picture of 33 x 17 pixels 7 kB, one of 100 x 100 120 kB.
        for (auto [largest, size, lost] : {std::tuple{10000, "33x17", 3}, {60000, "100x100", 3}}) {
            TemporaryFolder folder;
            Words words = {"scenes/cornell.pbrt",
                           "--spp",
                           "2",
                           "--patches",
                           "300",
                           "--quiet",
                           "--size",
                           size,
                           "--shots",
                           "50",
                           "--every",
                           "25"};
            for (auto [option, name] : {std::pair{"--film", "a.film"},
                                        {"--mesh", "a.ply"},
                                        {"--out", "a.pfm"},
                                        {"--out", "b.ppm"},
                                        {"--stats", "a.json"}}) {
                words.push_back(option), words.push_back(folder / name);
            }
            rlimit limit = {static_cast<rlim_t>(largest), static_cast<rlim_t>(largest)};
            Finished end = Process([&] {
                               ::setrlimit(RLIMIT_FSIZE, &limit);
                               return execute("26_radiosity", words);
                           }).wait();
            CAPTURE(end.err);
            CHECK(end.code == 1);
            CHECK(std::count(end.err.begin(), end.err.end(), '\n') == lost);
            std::set<std::string> left = {"a.film", "a.ply", "b.ppm", "a.json"};
            if (largest == 10000) {  // the film is tried twice
                left = {"a.pfm", "a-000025.pfm", "a-000050.pfm", "b.ppm", "a.json"};
            }
            CHECK(folder.names() == left);
        }
    }
}

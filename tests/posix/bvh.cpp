// The memory that building takes, and other instructions, which make compiles for.
#include <doctest/doctest.h>

#include "common/geometry/bvh_build.h"
#include "tests/support/meshes.h"
#include "tests/support/process.h"
#include "tests/support/program.h"

namespace fs = std::filesystem;

namespace {

/// Bytes, the most that this process has had so far.
double peak_memory() {
    rusage used = {};
    ::getrusage(RUSAGE_SELF, &used);
#ifdef __APPLE__
    return static_cast<double>(used.ru_maxrss);
#else
    return 1024.0 * static_cast<double>(used.ru_maxrss);  // others count in kB
#endif
}

Finished shell(const std::string& command) {
    return Process([&] {
               ::execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
               return 127;
           })
        .wait();
}

}  // namespace

TEST_SUITE("ch06 bvh slow") {
    TEST_CASE("truth: building over 10 million triangles takes less than 200 bytes for each") {
        // Beside the mesh itself; in a process of its own, which starts without used memory.
        Finished end = Process([] {
                           constexpr uint32_t side = 2237;
                           Geometry g;
                           add_surface(g, side, side, [](float a, float b) {
                               return Vec3{a, b, 0.1f * std::sin(50 * a) * std::sin(60 * b)};
                           });
                           double before = peak_memory(), n = static_cast<double>(g.size());
                           Bvh bvh = build_bvh(g, 2);
                           bool holds_all = bvh.blocks.size() * lanes >= g.size();
                           std::printf("%.0f %.1f\n", n, (peak_memory() - before) / n);
                           return holds_all ? 0 : 1;
                       }).wait();
        REQUIRE(end.code == 0);
        double triangles = 0, bytes = 0;
        REQUIRE(std::sscanf(end.out.c_str(), "%lf %lf", &triangles, &bytes) == 2);
        CHECK(triangles > 1e7);
        MESSAGE("bytes per triangle at the peak: " << bytes);
        CHECK(bytes > 32);
        CHECK(bytes < 200);
    }

    TEST_CASE("agreement: the same pictures with AVX-512, with AVX2, and without") {
        fs::path build = program_folder;
        for (const std::string chapter : {"07_path_tracing", "15_mis_ris"}) {
            for (std::string instructions : {"x86-64", "x86-64-v3"}) {
                // Without what the make around this one hands down.
                fs::path other = build / instructions;
                std::string program = other / chapter;
                Finished made =
                    shell("env -u MAKEFLAGS -u MAKELEVEL make BUILD='" + other.string() +
                          "' OPT=-O1 CPU='-march=" + instructions + "' '" + program + "'");
                CAPTURE(made.err);
                REQUIRE(made.code == 0);
                int pictures = 0;
                TemporaryFolder folder;
                for (const auto& entry : fs::directory_iterator("tests/pictures/references")) {
                    if (entry.path().extension() != ".pbrt") continue;
                    auto render = [&](const std::string& by, const std::string& picture) {
                        return shell("'" + by + "' '" + entry.path().string() +
                                     "' --size 64x64 --spp 4 --quiet --out '" + picture + "'")
                            .code;
                    };
                    // Not every chapter knows what every scene needs.
                    if (render(build / chapter, folder / "a.pfm") != 0) continue;
                    CAPTURE(entry.path());
                    REQUIRE(render(program, folder / "b.pfm") == 0);
                    bool same = read_file(folder / "a.pfm") == read_file(folder / "b.pfm");
                    CHECK(same);
                    pictures++;
                }
                CHECK(pictures >= 7);
            }
        }
    }
}

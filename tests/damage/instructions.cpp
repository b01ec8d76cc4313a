// The same pictures by other instructions, which make compiles for.
#include <doctest/doctest.h>

#include "tests/support/process.h"
#include "tests/support/program.h"

namespace fs = std::filesystem;

namespace {

Finished shell(const std::string& command) {
    return Process([&] {
               ::execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
               return 127;
           })
        .wait();
}

}  // namespace

TEST_SUITE("ch06 bvh slow") {
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

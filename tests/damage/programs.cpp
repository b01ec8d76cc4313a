// The programs, as the shell finds them.
#include <doctest/doctest.h>

#include "common/picture/image.h"
#include "tests/support/run_program.h"

namespace fs = std::filesystem;

TEST_SUITE("programs") {
    TEST_CASE("files: from any folder the default scene is found, and out/ is made there") {
        TemporaryFolder folder;
        std::string program = fs::absolute(program_file(path_tracer)).string();
        fs::create_symlink(program, folder / "linked");
        auto run_in = [&](const std::string& place, const std::string& command) {
            return Process([&] {
                       fs::current_path(place);
                       std::string path = fs::path(program).parent_path().string() + ":/bin";
                       ::setenv("PATH", path.c_str(), 1);
                       std::string options = " --size 9x9 --spp 1 --max-depth 1";
                       ::execl("/bin/sh", "sh", "-c", (command + options).c_str(), nullptr);
                       return 127;
                   })
                .wait();
        };
        for (const std::string& command : {program, path_tracer, std::string("./linked")}) {
            CAPTURE(command);
            Finished end = run_in(folder.path(), command);
            CHECK(end.code == 0);
            CHECK(end.err == "");
            CHECK(end.out.find("/scenes/cornell.pbrt  9x9  1 spp\n") != std::string::npos);
            CHECK(read_image(folder / "out/07_path_tracing.ppm").width == 9);
            fs::remove_all(folder / "out");
        }
    }
}

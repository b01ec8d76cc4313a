// What programs render and print is what it was: every command of four pages runs, and what it
// prints is compared with the page, but for times. After a change that is wanted `make readmes`
// writes the pages again, and somebody reads the difference before it is committed. On other
// systems the tests that compare programs' pictures do the same.
#include <doctest/doctest.h>

#include "tests/support/process.h"

#ifndef _WIN32
TEST_SUITE("printed") {
    void check_page(const std::string& page) {
        if (std::getenv("RUN") != nullptr && *std::getenv("RUN") != '\0') return;  // an emulator
        Finished end = Process({"env", "BUILD=" + file_name(program_folder),
                                "common/tools/fill_readmes", "--check", "tests/printed/" + page})
                           .wait();
        CAPTURE(end.err);
        CHECK(end.code == 0);
    }
    TEST_CASE("files: programs render what they did") { check_page("pictures.md"); }
    TEST_CASE("files: programs render what they did by options") { check_page("options.md"); }
    TEST_CASE("files: programs print what they did") { check_page("runs.md"); }
    TEST_CASE("files: programs explain paths as they did") { check_page("paths.md"); }
}
#endif

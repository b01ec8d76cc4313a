// Renders that are killed, and parts by job runners: short forms of make kills and make parts.
#include <doctest/doctest.h>

#include "tests/support/process.h"
#include "tests/support/program.h"

namespace {

Finished run_script(const std::string& script, const std::string& argument) {
    return Process([&] {
               ::execlp("bash", "bash", script.c_str(), program_folder.c_str(), argument.c_str(),
                        nullptr);
               return 127;
           })
        .wait();
}

}  // namespace

TEST_SUITE("films, slow") {
    TEST_CASE("identity: renders killed 30 times have the bytes of undisturbed ones") {
        Finished end = run_script("tests/kills", "30");
        CHECK(end.code == 0);
        MESSAGE(end.out);
    }

    TEST_CASE("identity: parts by a job runner have the bytes of one run") {
        Finished end = run_script("tests/parts", "");
        CHECK(end.code == 0);
        MESSAGE(end.out);
    }
}

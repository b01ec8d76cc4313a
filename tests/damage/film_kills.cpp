// Renders that are killed, and parts by job runners.
#include <doctest/doctest.h>

#include "tests/support/process.h"
#include "tests/support/program.h"

namespace {

Finished run_script(const char* script, const std::vector<std::string>& arguments) {
    std::vector<std::string> words = {"bash", script, program_folder};
    words.insert(words.end(), arguments.begin(), arguments.end());
    return Process(words).wait();
}

}  // namespace

TEST_SUITE("films, slow") {
    TEST_CASE("identity: renders killed 30 times lose nothing") {
        Finished end = run_script("tests/damage/kills", {"30"});
        CHECK(end.code == 0);
        MESSAGE(end.out);
    }

    TEST_CASE("identity: parts by a job runner have the bytes of one run") {
        Finished end = run_script("tests/damage/parts", {});
        CHECK(end.code == 0);
        MESSAGE(end.out);
    }
}

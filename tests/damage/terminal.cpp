// What is printed on a terminal, and what ends a program at once.
#include <doctest/doctest.h>
#include <stdlib.h>
#include <termios.h>

#include <filesystem>

#include "tests/support/run_program.h"

namespace {

/// A new terminal; -1 where there are none.
int terminal() {
    int other = ::posix_openpt(O_RDWR | O_NOCTTY);
    if (other < 0 || ::grantpt(other) != 0 || ::unlockpt(other) != 0) return -1;
    return ::open(::ptsname(other), O_RDWR | O_NOCTTY);
}

}  // namespace

TEST_SUITE("surroundings") {
    TEST_CASE("truth: a stopped terminal or a full pipe behind stderr stops no render") {
        TemporaryFolder folder;
        for (bool is_terminal : {true, false}) {
            CAPTURE(is_terminal);
            std::string out = folder / (is_terminal ? "a.ppm" : "b.ppm");
            Process process([&] {
                int ends[2] = {-1, -1};
                if (is_terminal) {
                    ends[1] = terminal();
                    ::tcflow(ends[1], TCOOFF);
                } else if (::pipe(ends) == 0) {
                    ::fcntl(ends[1], F_SETFL, O_NONBLOCK);
                    while (::write(ends[1], "x", 1) == 1) {
                    }
                    ::fcntl(ends[1], F_SETFL, 0);
                }
                if (ends[1] < 0) return 77;
                ::dup2(ends[1], STDERR_FILENO);
                return execute(path_tracer,
                               {spheres, "--size", "16x16", "--time", "0.5", "--out", out});
            });
            for (int ms = 0; ms < 20000 && !std::filesystem::exists(out); ms += 10) ::usleep(10000);
            ::usleep(200'000);
            process.kill(SIGKILL);  // where it waits
            Finished end = process.wait();
            if (end.code == 77) {
                MESSAGE("skipped: no terminals here");
                continue;
            }
            CHECK(end.code == 0);
            CHECK(read_file(out).size() > 16 * 16 * 3);
        }
    }
}

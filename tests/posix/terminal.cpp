// What is printed on a terminal, and what ends a program at once.
#include <doctest/doctest.h>
#include <poll.h>
#include <stdlib.h>
#include <termios.h>

#include <filesystem>

#include "common/rendering/progress.h"
#include "tests/support/run_program.h"
#include "tests/support/stand_ins.h"

namespace {

/// A new terminal, whose other end is `master`; -1 where there are none.
int terminal(int* master = nullptr) {
    int other = ::posix_openpt(O_RDWR | O_NOCTTY);
    if (other < 0 || ::grantpt(other) != 0 || ::unlockpt(other) != 0) return -1;
    if (master != nullptr) *master = other;
    return ::open(::ptsname(other), O_RDWR | O_NOCTTY);
}

/// What `work` prints on stderr, which is a terminal.
template <class Work>
std::string on_terminal(const Work& work) {
    return Process([&] {
               int master = -1, slave = terminal(&master);
               if (slave < 0) return 77;
               ::dup2(slave, STDERR_FILENO);
               work();
               std::fflush(stderr);
               for (pollfd more = {master, POLLIN, 0}; ::poll(&more, 1, 200) == 1;) {
                   char text[4096];
                   ssize_t n = ::read(master, text, sizeof text);
                   if (n > 0) std::fwrite(text, 1, static_cast<size_t>(n), stdout);
               }
               return 0;
           })
        .wait()
        .out;
}
template <class Work>
std::string in_file(const Work& work) {
    return Process([&] { return work(), 0; }).wait().err;
}

}  // namespace

TEST_SUITE("surroundings") {
    TEST_CASE("truth: progress is a bar on a terminal, and a line a minute in a file") {
        auto work = [](bool quiet) {
            return [=] {
                Progress progress(quiet);
                progress.show(0.25, 0.05);  // too early
                progress.show(0.5, 10);
                progress.show(0.75, 61);
                progress.show(0.8, 62);
                progress.show(1.5, 122);
            };
        };
        CHECK(in_file(work(false)) == " 75 %  20 s left\n100 %  0 s left\n");
        CHECK(in_file(work(true)) == "");
        std::string bar = on_terminal(work(false));
        if (bar.empty()) return;  // no terminals here
        CHECK(bar.starts_with("\r[#"));
        CHECK(bar.find("] 100 %  0 s left") != std::string::npos);
        CHECK(bar.ends_with("\r\x1b[K"));
        CHECK(on_terminal(work(true)) == "");
    }

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

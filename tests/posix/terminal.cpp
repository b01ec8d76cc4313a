// What is printed on a terminal, and what ends a program at once.
#include <doctest/doctest.h>
#include <poll.h>
#include <stdlib.h>
#include <termios.h>

#include <filesystem>

#include "common/options/options.h"
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

std::string help_of(const std::vector<std::string>& takes, std::vector<Option> extra) {
    return Process([&] {
               std::string words[] = {"build/07_x", "--help"};
               char* argv[] = {words[0].data(), words[1].data()};
               parse_render_options(2, argv, "07_x", "scenes/a.pbrt", extra, takes);
               return 9;
           })
        .wait()
        .out;
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
        const std::string fifteen(15, '#'), seven(7, ' '), end = "\x1b[K";
        CHECK(on_terminal(work(false)) ==
              "\r[" + fifteen + std::string(15, ' ') + "]  50 %  10 s left" + end + "\r[" +
                  fifteen + "#######" + std::string(8, ' ') + "]  75 %  20 s left" + end + "\r[" +
                  fifteen + "#########" + std::string(6, ' ') + "]  80 %  16 s left" + end + "\r[" +
                  fifteen + fifteen + "] 100 %  0 s left" + end + "\r" + end);
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

    TEST_CASE("truth: --help has a line for each option, and leaves out what means nothing") {
        std::vector<Option> extra = {
            {"way", "KIND", "a way", [](const std::string&) {}, "short"},
            {"hidden", "", "", [](const std::string&) {}},
            {"a-very-long-option", "ARGUMENT", "long", [](const std::string&) {}}};
        CHECK(help_of({"spp", "quiet"}, extra) ==
              "usage: build/07_x [SCENE] [OPTION]...\n"
              "Chapter 07_x on a pbrt-v4 scene (default: the project's scenes/a.pbrt).\n"
              "Writes into the folder where it is started. Ctrl-C keeps the picture so far: exit "
              "code 3.\n\n"
              "  --way KIND               a way\n"
              "  --a-very-long-option ARGUMENT long\n"
              "  --spp N                  samples per pixel (default: as the scene says)\n"
              "  --quiet                  print errors only\n"
              "  --help                   print this and stop\n");
        std::string all = help_of({}, {});
        CHECK(all.find("\n  --out FILE               .ppm, .pfm or .png; may be repeated (default "
                       "out/07_x.ppm)\n") != std::string::npos);
        CHECK(std::count(all.begin(), all.end(), '\n') == 4 + 18 + 1);
        // Each line has a name, and words behind it.
        for (size_t at = all.find("\n  --"); at != std::string::npos;
             at = all.find("\n  --", at + 1)) {
            std::string line = all.substr(at + 1, all.find('\n', at + 1) - at - 1);
            CAPTURE(line);
            REQUIRE(line.size() > 32);
            CHECK(line[26] == ' ');
            CHECK(line[27] != ' ');
        }
        CHECK(error_of([&] {
                  parsed({"--part", "1/2"}, extra, {"spp"});
              }) == "error: option '--part' means nothing to 07_x; --help lists those that do");
    }
}

// Signals that end a program, or that it ignores.
#include "common/program/render.h"

#include <doctest/doctest.h>

#include <csignal>

#include "common/base/system.h"
#include "common/rendering/stop.h"
#include "tests/support/process.h"
#include "tests/support/stand_ins.h"

TEST_SUITE("render loop") {
    TEST_CASE("truth: the same signal later ends the program; an ignored one does nothing") {
        for (int signal : {SIGINT, SIGTERM, SIGHUP}) {
            auto raising = [=](const Scene&, Ray, Sampler&, Recorder&) {
                std::raise(signal);
                return Rgb{};
            };
            CHECK(Process([&] {
                      std::signal(signal, SIG_DFL);
                      StopOnSignal stop;
                      std::raise(signal);
                      ::usleep(600'000);
                      std::raise(signal);
                      return 0;
                  })
                      .wait()
                      .signal == signal);
            CHECK(Process([&] {
                      std::signal(signal, SIG_IGN);  // as nohup does
                      Rendering r = render_film(empty_scene(3, 3, 2), stand_in_options(1), raising);
                      return r.stats.interrupted ? 1 : static_cast<int>(r.film.spp());
                  })
                      .wait()
                      .code == 2);
        }
    }

    TEST_CASE("truth: signals that end a program by default let the render end first") {
        for (int signal : {SIGHUP, SIGINT, SIGQUIT, SIGPIPE, SIGALRM, SIGTERM, SIGUSR1, SIGXFSZ}) {
            CAPTURE(signal);
            // timeout sends each signal twice at once, and a terminal that closes others with it.
            auto raising = [=](const Scene&, Ray, Sampler&, Recorder&) {
                std::raise(signal);
                return Rgb{};
            };
            Finished end = Process([&] {
                               prepare_streams();
                               StopOnSignal until_the_end;
                               Rendering r = render_film(empty_scene(300, 300, 1),
                                                         stand_in_options(1), raising);
                               for (int other : {SIGINT, SIGTERM, SIGHUP}) std::raise(other);
                               return r.stats.interrupted ? 3 : 0;
                           }).wait();
            bool is_error_of_writing = signal == SIGPIPE || signal == SIGXFSZ;
            CHECK(end.code == (is_error_of_writing ? 0 : 3));
        }
    }
}

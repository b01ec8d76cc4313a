// Signals that end a program, or that it ignores.
#include "common/render/render.h"

#include <doctest/doctest.h>

#include <csignal>

#include "common/base/system.h"
#include "common/render/stop.h"
#include "tests/support/process.h"
#include "tests/support/stand_ins.h"

TEST_SUITE("render loop") {
    TEST_CASE("truth: a signal ends the render, later the program; an ignored one does nothing") {
        auto code_of = [](int signal, bool ignored) {
            return Process([=] {
                       prepare_streams();
                       if (ignored) std::signal(signal, SIG_IGN);  // as nohup does
                       auto raising = [=](const Scene&, Ray, Sampler&, Recorder&) {
                           std::raise(signal);
                           return Rgb{};
                       };
                       Limit until_the_end;
                       Rendering r =
                           render_film(empty_scene(300, 300, 1), stand_in_options(1), raising);
                       // timeout sends each signal twice at once; a terminal that closes, others.
                       for (int other : {SIGINT, SIGTERM, SIGHUP})
                           if (!ignored) std::raise(other);
                       return r.stats.interrupted ? 3 : 0;
                   })
                .wait()
                .code;
        };
        for (int signal : stop_signals) {
            CHECK(code_of(signal, false) == 3);
            CHECK(code_of(signal, true) == 0);
            CHECK(Process([=] {
                      Limit stop;
                      std::raise(signal);
                      ::usleep(600'000);
                      std::raise(signal);
                      return 0;
                  })
                      .wait()
                      .signal == signal);
        }
        // Errors of writing.
        for (int signal : {SIGPIPE, SIGXFSZ}) CHECK(code_of(signal, false) == 0);
    }
}

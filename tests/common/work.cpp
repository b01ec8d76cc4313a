// What long commands say.
#include "tests/support/work.h"

#include <doctest/doctest.h>

#include "tests/support/process.h"

TEST_SUITE("work") {
    TEST_CASE("truth: the time left is as long as the share of the work that is left") {
        CHECK(Work::line("cornell, 15", 0, 0) == "[  0 %] cornell, 15");
        CHECK(Work::line("cornell, 15", 0.25, 30) ==
              "[ 25 %] cornell, 15: 30 s so far, about 90 s left");
        CHECK(Work::line("a", 0.5, 600) == "[ 50 %] a: 10 min so far, about 10 min left");
        CHECK(duration(3 * 3600) == "3.0 h");
    }

    TEST_CASE("truth: in a file work says what it is, and no more while it is short") {
        Finished end = captured([] {
            Work work("chart: 3 scenes", 3, 600);
            for (const char* name : {"a", "b", "c"}) work.next(name);
            say_wrote("out/chart.tsv");
            return 0;
        });
        CHECK(end.out == "");
        CHECK(end.err == "chart: 3 scenes, about 10 min\nwrote out/chart.tsv\n");
    }
}

// Error against passes of chapter 25: with its first radius for ever, and with one that shrinks.
#include <cstdio>

#include "common/base/stats.h"
#include "common/options/command_line.h"
#include "tests/measure/floor_in_mirror.h"

namespace {

struct Errors {
    RunningStats one_radius, shrinking;
};

Errors errors_after(const FloorInMirror& floor, int passes) {
    Errors e;
    for (uint32_t seed = 1; seed <= (passes < 100 ? 200 : passes < 1000 ? 50 : 16); seed++) {
        e.one_radius.add(floor.error(passes, false, seed));
        e.shrinking.add(floor.error(passes, true, seed));
    }
    return e;
}

}  // namespace

int main(int argc, char** argv) {
    return run_program([&] {
        parse_options(argc, argv, "",
                      "Error against passes of chapter 25, on a floor that is lit by a mirror and "
                      "seen in it, beside what theory says: with one radius, the squared bias and "
                      "the noise of a pass divided by their number; with a radius that shrinks, "
                      "N^(-2/3) from 10 passes on.",
                      {}, {});
        FloorInMirror floor;
        double bias2 = FloorInMirror::bias2();
        std::printf("passes  one radius   theory  shrinking   theory\n");
        double noise = 0, of_ten = 0;
        for (int passes : {1, 10, 100, 1000}) {
            Errors e = errors_after(floor, passes);
            if (passes == 1) noise = e.one_radius.mean() - bias2;
            if (passes == 10) of_ten = e.shrinking.mean();
            std::printf("%6d %11.2g %8.2g %10.2g", passes, e.one_radius.mean(),
                        bias2 + noise / passes, e.shrinking.mean());
            if (passes > 1) std::printf(" %8.2g", of_ten * std::pow(passes / 10.0, -2.0 / 3));
            std::printf("\n");
        }
        return 0;
    });
}

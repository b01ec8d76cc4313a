// fuzz_reader [COUNT [FIRST]]: the readers against damaged scenes, meshes and pictures (see
// scenes.h).
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>

#define DOCTEST_CONFIG_DISABLE  // this is no test, though it uses the same helpers
#include "tests/damage/scenes.h"
#include "tests/support/folder.cpp"

namespace {

/// The most memory that this process has had, in bytes.
double peak_memory() {
    rusage usage = {};
    ::getrusage(RUSAGE_SELF, &usage);
#ifdef __APPLE__
    return static_cast<double>(usage.ru_maxrss);
#else
    return static_cast<double>(usage.ru_maxrss) * 1024;
#endif
}

// The input that is read, for the handler of the signal that ends it.
volatile uint32_t current = 0;

void end_slow_input(int) {
    std::fprintf(stderr, "input %u takes too long\n", static_cast<unsigned>(current));
    std::_Exit(1);
}

/// Gives the next input its time; one that needs more ends the program, with its number.
void begin_input(uint32_t number) {
    current = number;
    ::alarm(static_cast<unsigned>(10 * most_seconds));
}

}  // namespace

int main(int argc, char** argv) {
    uint32_t count = argc > 1 ? static_cast<uint32_t>(std::atoi(argv[1])) : 100'000;
    uint32_t first = argc > 2 ? static_cast<uint32_t>(std::atoi(argv[2])) : 0;
    try {
        std::signal(SIGALRM, end_slow_input);
        FuzzResult result = fuzz(first, count, begin_input);
        std::printf(
            "%u damaged inputs: %llu read, %llu refused, the slowest in %.3f s, %.0f MB at most\n",
            count, static_cast<unsigned long long>(result.read),
            static_cast<unsigned long long>(result.refused), result.slowest, peak_memory() / 1e6);
        if (peak_memory() > 1e9) throw std::logic_error("more than 1 GB of memory");
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}

// fuzz_reader [COUNT [FIRST]]: the readers against damaged scenes, meshes and pictures (see
// scenes.h).
#include <sys/resource.h>

#include <cstdio>
#include <cstdlib>

#define DOCTEST_CONFIG_DISABLE  // this is no test, though it uses the same helpers
#include "tests/damage/scenes.h"

int main(int argc, char** argv) {
    uint32_t count = argc > 1 ? static_cast<uint32_t>(std::atoi(argv[1])) : 100'000;
    uint32_t first = argc > 2 ? static_cast<uint32_t>(std::atoi(argv[2])) : 0;
    try {
        FuzzResult result = fuzz(first, count);
        rusage usage = {};
        ::getrusage(RUSAGE_SELF, &usage);
#ifdef __APPLE__
        double peak = static_cast<double>(usage.ru_maxrss);
#else
        double peak = static_cast<double>(usage.ru_maxrss) * 1024;
#endif
        std::printf("%u damaged inputs: %u read, %u refused, %.0f MB at most\n", count, result.read,
                    result.refused, peak / 1e6);
        if (peak > 1e9) throw std::logic_error("more than 1 GB of memory");
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}

// fuzz_reader [COUNT [FIRST]]: the reader against damaged scenes and meshes; see fuzz.h.
#include <sys/resource.h>

#include <cstdio>
#include <cstdlib>

#include "tests/fuzz/fuzz.h"

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

}  // namespace

int main(int argc, char** argv) {
    uint32_t count = argc > 1 ? static_cast<uint32_t>(std::atoi(argv[1])) : 100'000;
    uint32_t first = argc > 2 ? static_cast<uint32_t>(std::atoi(argv[2])) : 0;
    try {
        FuzzResult result = fuzz(first, count);
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

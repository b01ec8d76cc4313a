// fuzz_reader [COUNT [FIRST]]: the reader against damaged scenes and meshes; see fuzz.h.
#include <cstdio>
#include <cstdlib>

#include "tests/fuzz/fuzz.h"

int main(int argc, char** argv) {
    uint32_t count = argc > 1 ? static_cast<uint32_t>(std::atoi(argv[1])) : 100'000;
    uint32_t first = argc > 2 ? static_cast<uint32_t>(std::atoi(argv[2])) : 0;
    try {
        FuzzResult result = fuzz(first, count);
        std::printf("%u damaged inputs: %llu read, %llu refused, the slowest in %.3f s\n", count,
                    static_cast<unsigned long long>(result.read),
                    static_cast<unsigned long long>(result.refused), result.slowest);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}

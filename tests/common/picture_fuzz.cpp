// A short run of the fuzzer of pictures; `make fuzz` is the long one.
#include <doctest/doctest.h>

#include "tests/fuzz/pictures.h"

TEST_SUITE("pictures on disk") {
    TEST_CASE("input: damaged pictures, notes and statistics are read or refused, and no more") {
        constexpr uint32_t count = 2000;
        FuzzResult result = fuzz_pictures(1'000'000, count);
        CHECK(result.read + result.refused == count);
        CHECK(result.read > count / 10);
        CHECK(result.refused > count / 3);
    }
}

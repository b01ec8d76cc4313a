// Short runs of the fuzzers; `make fuzz` is the long one.
#include <doctest/doctest.h>

#include "tests/damage/scenes.h"

TEST_SUITE("reader: malformed input") {
    TEST_CASE("input: damaged scenes and meshes are read or refused, and nothing else happens" *
              doctest::skip()) {
        constexpr uint32_t count = 3000;
        FuzzResult result = fuzz(1'000'000, count);
        CHECK(result.read + result.refused == count);
        // Both ends are met, or the damage would be too great or too small to show anything.
        CHECK(result.read > count / 20);
        CHECK(result.refused > count / 3);
    }
}

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

    TEST_CASE("identity: a PLY file of any types, orders and formats is read as it was written") {
        size_t read = 0;
        for (uint32_t i = 0; i < 2000; i++) {
            // Number 25931: lines end with CR, and the first byte of the body is an LF.
            Dice dice(i == 0 ? 25931 : i);
            RandomPly ply = random_ply(dice);
            if (ply.mesh.indices.empty()) continue;
            CAPTURE(i);
            TriangleMesh mesh = parse_ply("mesh.ply", ply.bytes);
            read++;
            CHECK(mesh.positions == ply.mesh.positions);
            CHECK(mesh.normals == ply.mesh.normals);
            CHECK(mesh.indices == ply.mesh.indices);
            CHECK(mesh.faces_left_out == ply.mesh.faces_left_out);
        }
        CHECK(read > 1200);
    }
}

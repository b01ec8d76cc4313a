// The tree of boxes against a scan of all of them.
#include "common/geometry/box_tree.h"

#include <doctest/doctest.h>

#include "tests/support/room_meshes.h"

namespace {

/// Boxes of this size at most, around points of the cube from -1 to 1; some flat, some points.
std::vector<Box> random_boxes(size_t count, float size, MeshRandom& random) {
    std::vector<Box> boxes;
    for (size_t i = 0; i < count; i++) {
        Vec3 low = random.in_cube(), sides;
        for (int axis = 0; axis < 3; axis++)
            if (random.between(0, 1) > 0.2f) sides[axis] = random.between(0, size);
        boxes.push_back({low, low + sides});
    }
    return boxes;
}

std::vector<uint32_t> near_by_scan(const std::vector<Box>& boxes, const Box& box, float gap) {
    std::vector<uint32_t> found;
    for (uint32_t i = 0; i < boxes.size(); i++) {
        bool near = true;
        for (int axis = 0; axis < 3; axis++) {
            near = near && boxes[i].low[axis] - box.high[axis] <= gap &&
                   box.low[axis] - boxes[i].high[axis] <= gap;
        }
        if (near) found.push_back(i);
    }
    return found;
}

}  // namespace

TEST_SUITE("box tree") {
    TEST_CASE("brute: a tree of boxes finds what a scan finds, and looks at few") {
        MeshRandom random(7);
        for (size_t count : {0u, 1u, 4u, 5u, 8u, 9u, 1000u}) {
            for (float size : {0.0f, 0.1f, 3.0f}) {
                CAPTURE(count);
                CAPTURE(size);
                std::vector<Box> boxes = random_boxes(count, size, random);
                BoxTree tree(boxes);
                for (const Box& box : random_boxes(30, size, random)) {
                    for (float gap : {0.0f, 0.05f})
                        CHECK(tree.near(box, gap) == near_by_scan(boxes, box, gap));
                }
                for (const Box& box : boxes)  // each is near itself
                    CHECK(std::ranges::count(tree.near(box, 0), &box - boxes.data()) == 1);
            }
        }
        // Boxes all alike, and those whose sides just touch.
        std::vector<Box> alike(50, Box{{0, 0, 0}, {1, 1, 1}});
        CHECK(BoxTree(alike).near({{1, 1, 1}, {2, 2, 2}}, 0).size() == 50);
        CHECK(BoxTree(alike).near({{1.5f, 1, 1}, {2, 2, 2}}, 0).empty());

        // Squares of a floor: the number looked at hardly grows with the number there is.
        double before = 0;
        for (int side : {30, 60, 120}) {
            std::vector<Box> floor;
            for (int i = 0; i < side * side; i++) {
                float x = static_cast<float>(i % side), z = static_cast<float>(i / side);
                floor.push_back({{x, 0, z}, {x + 1, 0, z + 1}});
            }
            BoxTree tree(floor);
            size_t looked_at = 0;
            for (const Box& box : floor) {
                size_t found = tree.near(box, 1e-3f, &looked_at).size();
                CHECK(found >= 4);
                CHECK(found <= 9);
            }
            double each = static_cast<double>(looked_at) / (side * side);
            CHECK(each < 100);
            if (before > 0) CHECK(each < 1.5 * before);
            before = each;
        }
    }
}

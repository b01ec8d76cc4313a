// Which boxes are near another one.
#pragma once
#include "common/geometry/geometry.h"

/// A tree of boxes: each node has a box around half of those of the node above it.
class BoxTree {
public:
    /// n log n for n boxes.
    explicit BoxTree(const std::vector<Box>& boxes);

    /// The numbers of the boxes that are at most `gap` away from `box` along each axis, from low to
    /// high. About log n, and what is found.
    /// `looked_at`, if any: how many boxes it had to look at is added.
    /// tested by  "brute: a tree of boxes finds what a scan finds, and looks at few"
    std::vector<uint32_t> near(const Box& box, float gap, size_t* looked_at = nullptr) const;

private:
    static constexpr uint32_t in_leaf = 4;  // boxes, at most
    struct Node {
        Box box;
        uint32_t first, last;  // of order_
        uint32_t right;        // the second child; the first comes next. 0: a leaf
    };
    void build(uint32_t first, uint32_t last);

    std::vector<Box> boxes_;
    std::vector<uint32_t> order_;
    std::vector<Node> nodes_;
};

// The hierarchy of bounding boxes that finds what a ray hits (chapter 05).
//
// scene.h includes this header, and chapter 04 has intersect_triangle() and its like as its own
// lesson: so this header must not include shapes.h; what needs it belongs into bvh.cpp.
#pragma once
#include "common/geometry.h"

/// Eight boxes side by side, and what is in them: one node of the hierarchy.
struct alignas(64) BvhNode {
    float plane[6][8];  // row 2 axis: lower, row 2 axis + 1: upper ends; lo > hi where unused
    uint32_t child[8];
    uint32_t order[8];  // for each octant of directions: the children from far to near, 4 bits each

    static constexpr uint32_t leaf = 1u << 31, mixed = 1u << 30, index = mixed - 1;
};

/// Eight primitives side by side: one leaf. Lanes that are no triangle have NaN for vertices.
struct alignas(64) BvhBlock {
    float vertex[9][8];  // row 3 k + axis: vertex k
    uint32_t prim[8];
};

/// A child is an index into nodes; or, with bit `leaf` set, into blocks; with bit `mixed` set too,
/// a block that holds spheres or disks.
struct Bvh {
    uint32_t root = 0;
    std::vector<BvhNode> nodes;
    std::vector<BvhBlock> blocks;
};

Bvh build_bvh(const Geometry& geometry, int threads);

/// The first primitive that the ray hits; of two at the same t the one with the lower number.
PrimHit closest_hit(const Bvh& bvh, const Geometry& geometry, const Ray& ray);
/// Whether the ray hits anything.
bool any_hit(const Bvh& bvh, const Geometry& geometry, const Ray& ray);

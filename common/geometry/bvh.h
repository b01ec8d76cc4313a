// The hierarchy of bounding boxes that finds what a ray hits (chapter 06).
#pragma once
#include "common/base/progress.h"
#include "common/geometry/geometry.h"
#include "common/geometry/pages.h"
#include "common/geometry/simd.h"

/// One node of the hierarchy: boxes side by side, and what is in each.
struct alignas(sizeof(Floats)) BvhNode {
    float plane[6][lanes];   // row 2 * axis: lower ends; + 1: upper ends; lower > upper: unused
    uint32_t child[lanes];   // index into Bvh::nodes, or leaf | index into Bvh::blocks
    LaneOrder far_first[8];  // for each octant (signs of a direction): children from far to near

    static constexpr uint32_t leaf = 1u << 31;
    static constexpr uint32_t mixed = 1u << 30;  // a leaf that does not hold triangles alone
    static constexpr uint32_t index = mixed - 1;
    static constexpr uint32_t nothing = ~0u;  // an unused child
};

/// One leaf: primitives side by side. Lanes that hold no triangle have NaN for vertices.
struct alignas(sizeof(Floats)) BvhBlock {
    float vertex[9][lanes];  // row 3 * k + axis: vertex k
    uint32_t prim[lanes];    // PrimHit::none: this lane and all after it are unused
};

/// Nodes with as many children as one instruction tests, leaves of as many triangles.
struct Bvh {
    uint32_t root = 0;  // as BvhNode::child; or leaf | number of blocks of triangles alone, which
                        // come first: then there are no nodes
    Vec3 centre;        // of the geometry: the boxes are relative to it
    std::vector<BvhNode, PageAllocator<BvhNode>> nodes;
    std::vector<BvhBlock, PageAllocator<BvhBlock>> blocks;
};

/// Builds the hierarchy over all primitives. It does not depend on the number of threads, to the
/// last bit. `report` hears how far it is.
Bvh build_bvh(const Geometry& geometry, int threads, const Report& report = {});

/// The first primitive that the ray hits, as linear_scan() finds it; of two at the same t the one
/// with the lower number. t is right to 1 part in 256 at the worst, and mostly to 1 in 100,000; of
/// a triangle seen next to edge-on, as far as the ray is; of one that the ray all but begins on, to
/// 2^-50 length^2 / height of it. Beyond coordinates of 1e9 float overflows.
/// tested by  "truth: every hit as in double precision", "truth: no ray meets the triangle that"
PrimHit closest_hit(const Bvh& bvh, const Geometry& geometry, const Ray& ray);
/// Whether the ray hits anything: stops at the first hit that it finds.
bool any_hit(const Bvh& bvh, const Geometry& geometry, const Ray& ray);

// The hierarchy of bounding boxes that finds what a ray hits (chapter 06).
#pragma once
#include <memory>
#ifdef __linux__
#include <sys/mman.h>
#endif

#include "common/geometry/geometry.h"
#include "common/geometry/simd.h"

/// Allocates in pages of 2 MB where the system has them: the processor looks up fewer addresses.
template <typename T>
struct PageAllocator : std::allocator<T> {
    T* allocate(size_t n) {
        T* p = std::allocator<T>::allocate(n);
#ifdef MADV_HUGEPAGE
        size_t in_page = reinterpret_cast<uintptr_t>(p) % 4096;
        if (n * sizeof(T) > size_t{4} << 20)
            madvise(reinterpret_cast<char*>(p) - in_page, in_page + n * sizeof(T), MADV_HUGEPAGE);
#endif
        return p;
    }
};

/// One node of the hierarchy: boxes side by side, and what is in each.
struct alignas(sizeof(Floats)) BvhNode {
    float plane[6][lanes];   // row 2 * axis: lower ends; + 1: upper ends; lower > upper: unused
    uint32_t child[lanes];   // index into Bvh::nodes, or leaf | index into Bvh::blocks
    LaneOrder far_first[8];  // for each octant (signs of a direction): children from far to near

    static constexpr uint32_t leaf = 1u << 31;
    static constexpr uint32_t nothing = ~0u;  // an unused child
};

/// One leaf: primitives side by side, triangles last. Lanes that hold none have NaN for vertices.
struct alignas(sizeof(Floats)) BvhBlock {
    float vertex[9][lanes];  // row 3 * k + axis: vertex k
    uint32_t prim[lanes];    // PrimHit::none: this lane and all after it are unused
};

/// Nodes with as many children as one instruction tests, leaves of as many triangles.
struct Bvh {
    Vec3 centre;  // of the geometry: the boxes are relative to it
    std::vector<BvhNode, PageAllocator<BvhNode>> nodes;  // the root first; none over a few blocks
    std::vector<BvhBlock, PageAllocator<BvhBlock>> blocks;
};

/// Builds the hierarchy over all primitives. It does not depend on the number of threads, to the
/// last bit.
Bvh build_bvh(const Geometry& geometry, int threads);

/// The first primitive that the ray hits, as linear_scan() finds it; of two at the same t the one
/// with the lower number. t is right to 1 part in 256 at the worst, and mostly to 1 in 100,000; of
/// a triangle seen next to edge-on, as far as the ray is; of one that the ray all but begins on, to
/// 2^-50 length^2 / height of it. Beyond coordinates of 1e9 float overflows.
/// tested by  "truth: every hit as in double precision", "truth: no ray meets the triangle that"
PrimHit closest_hit(const Bvh& bvh, const Geometry& geometry, const Ray& ray);
/// Whether the ray hits anything: stops at the first hit that it finds.
bool any_hit(const Bvh& bvh, const Geometry& geometry, const Ray& ray);

// The hierarchy of bounding boxes that finds what a ray hits (chapter 06).
#pragma once
#include <new>
#ifdef __linux__
#include <sys/mman.h>
#endif

#include "common/base/progress.h"
#include "common/geometry/geometry.h"
#include "common/geometry/simd.h"

/// Allocates from the start of a cache line, and large arrays in pages of 2 MB where the system
/// has them: the processor then looks up fewer addresses.
template <typename T>
struct PageAllocator {
    using value_type = T;

    PageAllocator() = default;
    template <typename U>
    PageAllocator(PageAllocator<U>) {}

    T* allocate(size_t n) {
        void* p = ::operator new (n * sizeof(T), std::align_val_t{alignment(n)});
#ifdef MADV_HUGEPAGE
        if (alignment(n) == large_page) madvise(p, n * sizeof(T), MADV_HUGEPAGE);
#endif
        return static_cast<T*>(p);
    }
    void deallocate(T* p, size_t n) { ::operator delete (p, std::align_val_t{alignment(n)}); }
    /// Leaves new elements unwritten, unless they are given a value.
    template <typename U>
    void construct(U* p) {
        ::new (static_cast<void*>(p)) U;
    }
    template <typename U>
    bool operator==(PageAllocator<U>) const {
        return true;
    }

private:
    static constexpr size_t cache_line = 64, large_page = size_t{2} << 20;
    static size_t alignment(size_t n) {
        return n * sizeof(T) < 2 * large_page ? cache_line : large_page;
    }
};

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

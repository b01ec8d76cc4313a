// Memory for large arrays that are read all over the place.
#pragma once
#include <cstdlib>
#include <new>
#ifdef __linux__
#include <sys/mman.h>
#endif

/// Allocates from the start of a cache line, and large arrays in pages of 2 MB where the system
/// has them: the processor then looks up fewer addresses.
template <typename T>
struct PageAllocator {
    using value_type = T;

    PageAllocator() = default;
    template <typename U>
    PageAllocator(PageAllocator<U>) {}

    T* allocate(size_t n) {
        constexpr size_t cache_line = 64, large_page = size_t{2} << 20;
        size_t bytes = n * sizeof(T), align = bytes < 2 * large_page ? cache_line : large_page;
        void* p = std::aligned_alloc(align, (bytes + align - 1) / align * align);
        if (p == nullptr) throw std::bad_alloc();
#ifdef MADV_HUGEPAGE
        if (align == large_page) madvise(p, bytes, MADV_HUGEPAGE);
#endif
        return static_cast<T*>(p);
    }
    void deallocate(T* p, size_t) { std::free(p); }
    /// Leaves new elements unwritten, unless they are given a value.
    template <typename U>
    void construct(U* p) {
        ::new (static_cast<void*>(p)) U;
    }
    template <typename U>
    bool operator==(PageAllocator<U>) const {
        return true;
    }
};

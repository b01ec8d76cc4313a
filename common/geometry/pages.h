// Memory for large arrays that are read all over the place.
#pragma once
#include <cstddef>
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

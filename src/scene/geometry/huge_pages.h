#pragma once

#include <sys/mman.h>

#include <cstdlib>
#include <new>

namespace frond {

/// Allocator of a large array that is read in random order: requests pages of 2 MB, which avoids most TLB misses. If
/// the system has no such pages, ordinary ones are used.
template <class T>
struct HugePages {
  using value_type = T;
  static constexpr size_t kPage = size_t{1} << 21;

  HugePages() = default;
  template <class U>
  HugePages(const HugePages<U>& /*other*/) {}  // NOLINT(google-explicit-constructor): as an allocator must

  T* allocate(size_t n) {
    const size_t bytes = n * sizeof(T);
    // A small array would waste most of its page.
    const size_t page = bytes < kPage ? alignof(T) : kPage, rounded = (bytes + page - 1) / page * page;
    void* const p = std::aligned_alloc(page, rounded);
    if (!p) throw std::bad_alloc();
    if (page == kPage) madvise(p, rounded, MADV_HUGEPAGE);
    return static_cast<T*>(p);
  }
  void deallocate(T* p, size_t /*n*/) { std::free(p); }

  friend bool operator==(const HugePages& /*a*/, const HugePages& /*b*/) { return true; }
};

}  // namespace frond

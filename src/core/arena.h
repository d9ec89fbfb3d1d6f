#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <new>
#include <type_traits>
#include <utility>

namespace frond {

/// Bump allocator for the BSDFs of one path vertex: nothing is freed, `reset` starts again, no heap in the loop.
class Arena {
 public:
  template <class T, class... Args>
  T* make(Args&&... args) {
    static_assert(std::is_trivially_destructible_v<T>, "an arena never runs destructors");
    const size_t start = (used_ + alignof(T) - 1) & ~(alignof(T) - 1);
    if (start + sizeof(T) > bytes_.size()) throw std::bad_alloc();
    used_ = start + sizeof(T);
    return ::new (static_cast<void*>(bytes_.data() + start)) T{std::forward<Args>(args)...};
  }
  void reset() { used_ = 0; }

 private:
  alignas(64) std::array<std::byte, 16384> bytes_;
  size_t used_ = 0;
};

}  // namespace frond

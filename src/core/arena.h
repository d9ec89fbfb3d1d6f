#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace frond {

/// Bump allocator for the BSDFs of one path vertex, as pbrt's ScratchBuffer. `reset` reuses its memory. It grows to the
/// size that the largest hit needs; from then on the render loop allocates nothing on the heap. Not thread-safe: each
/// thread has its own.
class Arena {
 public:
  /// Constructs a T that lives until `reset`; its destructor is not run.
  template <class T, class... Args>
  T* make(Args&&... args) {
    static_assert(std::is_trivially_destructible_v<T>, "an arena never runs destructors");
    static_assert(alignof(T) <= kAlignment);
    size_t start = (used_ + alignof(T) - 1) & ~(alignof(T) - 1);
    if (start + sizeof(T) > block_->size) {
      next_block(sizeof(T));
      start = 0;
    }
    used_ = start + sizeof(T);
    return ::new (static_cast<void*>(block_->bytes + start)) T{std::forward<Args>(args)...};
  }
  /// Invalidates all objects of the arena and keeps its memory.
  void reset() {
    block_ = blocks_.front().get();
    used_ = 0;
  }
  /// Bytes allocated on the heap.
  size_t capacity() const {
    size_t sum = 0;
    for (const auto& block : blocks_) sum += block->size;
    return sum;
  }

 private:
  static constexpr size_t kAlignment = 64, kFirstSize = 16384;

  struct Block {
    explicit Block(size_t bytes_) : size(bytes_), bytes(static_cast<std::byte*>(::operator new(bytes_, kAligned))) {}
    ~Block() { ::operator delete(bytes, kAligned); }
    Block(const Block&) = delete;
    Block& operator=(const Block&) = delete;
    static constexpr std::align_val_t kAligned{kAlignment};
    size_t size;
    std::byte* bytes;
  };

  void next_block(size_t least) {
    auto next = std::ranges::find(blocks_, block_, &std::unique_ptr<Block>::get) + 1;
    while (next != blocks_.end() && (*next)->size < least) ++next;
    if (next == blocks_.end())
      next = blocks_.insert(next, std::make_unique<Block>(std::max(2 * blocks_.back()->size, least)));
    block_ = next->get();
  }

  std::vector<std::unique_ptr<Block>> blocks_ = first_block();
  Block* block_ = blocks_.front().get();
  size_t used_ = 0;

  static std::vector<std::unique_ptr<Block>> first_block() {
    std::vector<std::unique_ptr<Block>> blocks;
    blocks.push_back(std::make_unique<Block>(kFirstSize));
    return blocks;
  }
};

}  // namespace frond

#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

namespace frond {

/// Set of paths of a bundle, by index.
class LaneSet {
 public:
  explicit LaneSet(uint32_t bits = 0) : bits_(bits) {}
  void add(size_t lane) { bits_ |= 1u << lane; }
  bool empty() const { return bits_ == 0; }
  size_t size() const { return size_t(std::popcount(bits_)); }
  uint32_t bits() const { return bits_; }

  /// Ascending.
  class Iterator {
   public:
    explicit Iterator(uint32_t left) : left_(left) {}
    size_t operator*() const { return size_t(std::countr_zero(left_)); }
    void operator++() { left_ &= left_ - 1; }
    bool operator!=(Iterator other) const { return left_ != other.left_; }

   private:
    uint32_t left_;
  };
  Iterator begin() const { return Iterator(bits_); }
  Iterator end() const { return Iterator(0); }

 private:
  uint32_t bits_;
};

}  // namespace frond

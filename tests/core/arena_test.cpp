#include "core/arena.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <random>

namespace frond {
namespace {

template <size_t kBytes>
struct Chunk {
  std::array<unsigned char, kBytes> bytes;
};

template <size_t kAlign>
struct alignas(kAlign) Aligned {
  unsigned char byte;
};

template <class T>
bool is_aligned(const T* pointer) {
  return reinterpret_cast<uintptr_t>(pointer) % alignof(T) == 0;
}

TEST(Arena, WhatIsMadeStaysWhileItGrows) {
  Arena arena;
  const size_t first = arena.capacity();
  using Thing = Chunk<200>;
  std::vector<Thing*> things;
  for (size_t i = 0; arena.capacity() < 10 * first; ++i) {
    things.push_back(arena.make<Thing>());
    things.back()->bytes.fill(static_cast<unsigned char>(i));
  }
  for (size_t i = 0; i < things.size(); ++i)
    for (const unsigned char byte : things[i]->bytes) ASSERT_EQ(byte, static_cast<unsigned char>(i)) << i;
}

TEST(Arena, EverythingIsAligned) {
  Arena arena;
  for (int i = 0; i < 2000; ++i) {
    EXPECT_TRUE(is_aligned(arena.make<Aligned<1>>()));
    EXPECT_TRUE(is_aligned(arena.make<Aligned<64>>()));
    EXPECT_TRUE(is_aligned(arena.make<Aligned<1>>()));
    EXPECT_TRUE(is_aligned(arena.make<Aligned<16>>()));
    EXPECT_TRUE(is_aligned(arena.make<double>(1.0)));
  }
}

TEST(Arena, WhatIsLargerThanABlockFitsToo) {
  Arena arena;
  using Large = Chunk<1 << 20>;
  arena.make<char>('a');
  Large* large = arena.make<Large>();
  std::memset(large->bytes.data(), 1, sizeof *large);
  EXPECT_EQ(*arena.make<char>('b'), 'b');
  EXPECT_EQ(large->bytes.back(), 1);
}

/// Makes things of three sizes in an order that the seed decides.
void fill(Arena& arena, unsigned seed) {
  std::mt19937 random(seed);
  for (int i = 0; i < 300; ++i) switch (random() % 3) {
      case 0:
        arena.make<Chunk<24>>();
        break;
      case 1:
        arena.make<Chunk<3000>>();
        break;
      default:
        arena.make<Chunk<40000>>();
        break;
    }
}

TEST(Arena, ResetUsesWhatThereIsAgain) {
  Arena arena;
  void* const start = arena.make<char>('a');
  fill(arena, 1);
  const size_t capacity = arena.capacity();
  for (int i = 0; i < 50; ++i) {
    arena.reset();
    EXPECT_EQ(arena.make<char>('b'), start);
    fill(arena, 1);
    EXPECT_EQ(arena.capacity(), capacity);
  }
}

/// Blocks double in size, and blocks that are too small for an object are skipped, so that the search terminates.
TEST(Arena, CapacityStaysNearTheLargestDemand) {
  Arena arena;
  for (unsigned seed = 0; seed < 200; ++seed) {
    arena.reset();
    fill(arena, seed);
  }
  const size_t capacity = arena.capacity();
  EXPECT_LT(capacity, 300u * 40000u * 4);
  for (unsigned seed = 0; seed < 200; ++seed) {
    arena.reset();
    fill(arena, seed);
  }
  EXPECT_EQ(arena.capacity(), capacity);
}

}  // namespace
}  // namespace frond

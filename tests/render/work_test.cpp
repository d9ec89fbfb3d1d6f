#include "render/film/work.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>

namespace frond {
namespace {

WorkItem box(int x0, int x1, int y0, int y1, uint64_t s0, uint64_t s1) { return {{x0, y0, x1, y1}, {s0, s1}}; }

TEST(Work, CountsItsPaths) {
  EXPECT_EQ(box(1, 4, 2, 4, 10, 15).paths(), 30u);
  for (const WorkItem& nothing : {box(1, 1, 2, 4, 0, 5), box(1, 4, 4, 2, 0, 5), box(1, 4, 2, 4, 5, 5),
                                  box(1, 4, 2, 4, 6, 5), box(4, 1, 4, 2, 0, 5)}) {
    EXPECT_TRUE(nothing.empty());
    EXPECT_EQ(nothing.paths(), 0u);
  }
  EXPECT_EQ(box(0, 65536, 0, 65536, 0, 1u << 30).paths(), uint64_t{1} << 62);
}

TEST(Work, WhatIsCoveredCannotBeCoveredAgain) {
  Coverage coverage;
  EXPECT_TRUE(coverage.add(box(0, 8, 0, 8, 0, 16)));
  const Coverage before = coverage;
  for (const WorkItem& again : {box(0, 8, 0, 8, 0, 16), box(7, 9, 7, 9, 15, 17), box(3, 4, 3, 4, 3, 4)}) {
    EXPECT_FALSE(coverage.add(again));
    EXPECT_EQ(coverage, before);
  }
  EXPECT_TRUE(coverage.add(box(3, 3, 0, 8, 0, 16)));  // nothing at all
  EXPECT_EQ(coverage, before);
  EXPECT_TRUE(coverage.add(box(8, 9, 7, 9, 15, 17)));
}

TEST(Work, NeighboursBecomeOne) {
  for (const auto& [a, b] : {std::pair{box(0, 4, 0, 4, 0, 5), box(0, 4, 0, 4, 5, 16)},
                             {box(0, 4, 0, 4, 0, 5), box(4, 7, 0, 4, 0, 5)},
                             {box(0, 4, 0, 4, 0, 5), box(0, 4, 4, 5, 0, 5)}}) {
    Coverage ab, ba;
    EXPECT_TRUE(ab.add(a) && ab.add(b));
    EXPECT_TRUE(ba.add(b) && ba.add(a));
    EXPECT_EQ(ab.items().size(), 1u);
    EXPECT_EQ(ab, ba);
    EXPECT_EQ(ab.items().front().paths(), a.paths() + b.paths());
  }
}

TEST(Work, WhatIsMissingIsNamed) {
  Coverage coverage;
  const WorkItem whole = box(0, 4, 0, 4, 0, 37);
  EXPECT_EQ(coverage.missing(whole), std::vector{whole});
  coverage.add(box(0, 4, 0, 4, 0, 5));
  coverage.add(box(0, 4, 0, 4, 16, 37));
  EXPECT_EQ(coverage.missing(whole), std::vector{box(0, 4, 0, 4, 5, 16)});
  coverage.add(box(0, 4, 0, 4, 5, 16));
  EXPECT_TRUE(coverage.missing(whole).empty());
  EXPECT_TRUE(coverage.missing(box(2, 2, 0, 4, 0, 99)).empty());
}

/// Set of cells of a small volume of pixels and samples.
class Cells {
 public:
  static constexpr int kSide = 7;

  static bool any_of(const WorkItem& item, const auto& holds) {
    for (int y = item.pixels.y0; y < item.pixels.y1; ++y)
      for (int x = item.pixels.x0; x < item.pixels.x1; ++x)
        for (uint64_t s = item.samples.begin; s < item.samples.end; ++s)
          if (holds(size_t(y), size_t(x), size_t(s))) return true;
    return false;
  }
  bool has_some_of(const WorkItem& item) const {
    return any_of(item, [this](size_t y, size_t x, size_t s) { return count_[y][x][s] > 0; });
  }
  void add(const WorkItem& item) {
    any_of(item, [this](size_t y, size_t x, size_t s) { return ++count_[y][x][s] < 0; });
  }
  /// Returns the cells of `item` that are not in this set.
  Cells rest_of(const WorkItem& item) const {
    Cells rest;
    any_of(item, [&](size_t y, size_t x, size_t s) { return (rest.count_[y][x][s] = count_[y][x][s] == 0) < 0; });
    return rest;
  }
  static Cells of(const std::vector<WorkItem>& items) {
    Cells cells;
    for (const WorkItem& item : items) cells.add(item);
    return cells;
  }
  friend bool operator==(const Cells&, const Cells&) = default;

 private:
  std::array<std::array<std::array<int, kSide>, kSide>, kSide> count_{};
};

WorkItem random_item(std::mt19937& random, int longest) {
  std::array<int, 6> ends{};
  for (size_t i = 0; i < 6; i += 2) {
    ends[i] = int(random() % Cells::kSide);
    ends[i + 1] = std::min<int>(ends[i] + 1 + int(random() % unsigned(longest)), Cells::kSide);
  }
  return box(ends[0], ends[1], ends[2], ends[3], uint64_t(ends[4]), uint64_t(ends[5]));
}

TEST(Work, CoverageIsThatOfItsCells) {
  std::mt19937 random(1);
  for (int round = 0; round < 300; ++round) {
    Coverage coverage;
    Cells cells;
    const int longest = 1 + round % 4;
    for (int i = 0; i < 60; ++i) {
      const WorkItem item = random_item(random, longest);
      EXPECT_EQ(Cells::of(coverage.missing(item)), cells.rest_of(item));
      const bool fits = !cells.has_some_of(item);
      ASSERT_EQ(coverage.add(item), fits);
      if (fits) cells.add(item);
      ASSERT_EQ(Cells::of(coverage.items()), cells);  // and each cell once
    }
  }
}

TEST(Work, IntersectionIsWhatBothHave) {
  std::mt19937 random(2);
  for (int i = 0; i < 500; ++i) {
    const WorkItem a = random_item(random, 5), b = random_item(random, 5), both = intersection(a, b);
    EXPECT_EQ(both, intersection(b, a));
    EXPECT_EQ(both.empty(), !Cells::of({a}).has_some_of(b));
    if (!both.empty()) {
      EXPECT_EQ(Cells::of(Coverage().missing(both)), Cells::of({both}));
    }
  }
}

/// Cuts a box into pieces that have nothing in common.
void cut(const WorkItem& item, std::mt19937& random, std::vector<WorkItem>& pieces) {
  const int width = item.pixels.width(), height = item.pixels.height(), depth = int(item.samples.count());
  const auto where = [&random](int length) { return 1 + int(random() % unsigned(length - 1)); };
  WorkItem a = item, b = item;
  switch (random() % 4) {
    case 0:
      if (width < 2) return pieces.push_back(item);
      a.pixels.x1 = b.pixels.x0 = item.pixels.x0 + where(width);
      break;
    case 1:
      if (height < 2) return pieces.push_back(item);
      a.pixels.y1 = b.pixels.y0 = item.pixels.y0 + where(height);
      break;
    case 2:
      if (depth < 2) return pieces.push_back(item);
      a.samples.end = b.samples.begin = item.samples.begin + uint64_t(where(depth));
      break;
    default:
      return pieces.push_back(item);
  }
  cut(a, random, pieces);
  cut(b, random, pieces);
}

/// Films are compared by it: the same work is the same coverage, in whatever order it came.
TEST(Work, TheSameCellsAreTheSameCoverage) {
  std::mt19937 random(3);
  const auto in_any_order = [&random](std::vector<WorkItem> pieces) {
    std::ranges::shuffle(pieces, random);
    Coverage coverage;
    for (const WorkItem& piece : pieces) EXPECT_TRUE(coverage.add(piece));
    return coverage;
  };
  for (int round = 0; round < 500; ++round) {
    std::vector<WorkItem> pieces;
    cut(box(0, 7, 0, 7, 0, 7), random, pieces);
    Coverage whole;
    whole.add(box(0, 7, 0, 7, 0, 7));
    EXPECT_EQ(in_any_order(pieces), whole);
    pieces.resize(pieces.size() / 2);
    EXPECT_EQ(in_any_order(pieces), in_any_order(pieces));
  }
}

}  // namespace
}  // namespace frond

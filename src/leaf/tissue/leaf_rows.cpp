#include "leaf/tissue/leaf_rows.h"

#include <algorithm>

namespace frond::leaf {

extern constinit const std::span<const LeafNumber> kLeafNumbers = kLeafRows;

namespace {

/// Members of TissueParams. A new member does not compile here: give it a row in leaf_rows.h, or state it in `describe`
/// (leaf_numbers.cpp) and count it among the others.
[[maybe_unused]] void members(const TissueParams& p) {
  [[maybe_unused]] const auto& [m1, m2, m3, m4, m5, m6, m7, m8, m9, m10, m11, m12, m13, m14] = p;
  constexpr size_t kMembers = 14;
  constexpr size_t kOthers = 5;  // structure, absorption tables, concentrations, pigments, sieve effect
  static_assert(std::ranges::count_if(kLeafRows, [](const LeafNumber& n) { return n.member; }) + kOthers == kMembers);
  static_assert(std::size(kLeafRows) <= kMostLeafNumbers);
}

}  // namespace
}  // namespace frond::leaf

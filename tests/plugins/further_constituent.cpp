// A table of a leaf's numbers with one more row than frond's. Loaded before libfrond (LD_PRELOAD), it is the table of
// the whole program: tests/constituent.
#include <algorithm>
#include <array>

#include "leaf/tissue/leaf_rows.h"

namespace frond::leaf {
namespace {

constexpr SpectrumNode kBetalains[] = {{400, 2000}, {480, 6000}, {535, 9000}, {600, 300}, {650, 0}, {2500, 0}};

constexpr LeafNumber kRow{.name = "betalains",
                          .action = LeafAction::absorption,
                          .unit = kMassPerVolume,
                          .range = {0, 100},
                          .doc = "Betalains in the mesophyll; by default the specimen's.",
                          .spectrum = kBetalains,
                          .content = {"betalains", kMicrogramsPerCm2, ""},
                          .fit_range = {1e-3, 100},
                          .little = 0.05};

constexpr auto kRows = [] {
  std::array<LeafNumber, std::size(kLeafRows) + 1> rows{};
  std::ranges::copy(kLeafRows, rows.begin());
  rows.back() = kRow;
  return rows;
}();

}  // namespace

extern constinit const std::span<const LeafNumber> kLeafNumbers = kRows;

}  // namespace frond::leaf

// Lists of numbers on the command line: 0,8,30 and 0:180:1.

#include "jobs/record/arguments.h"
#include "tests/fuzz/fuzz.h"

using namespace frond;

FROND_FUZZ_TARGET(numbers, bytes) {
  const auto numbers = parse_numbers(bytes);
  if (!numbers) return;
  constexpr size_t kMost = size_t{1} << 24;  // a short range may have many steps
  fuzz::require(numbers->size() <= kMost, "a list is bounded");
  fuzz::require_finite(*numbers, "a number");
}

#include "leaf/solve/reduced_basis.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace frond::leaf {
namespace {

using Column = std::vector<double>;

double largest(const Column& c) {
  double result = 0;
  for (const double x : c) result = std::max(result, std::abs(x));
  return result;
}

/// Exponentials of many decays: smooth in the column's number.
std::vector<Column> decays(size_t count) {
  std::vector<Column> columns;
  for (size_t c = 0; c < count; ++c) {
    Column& column = columns.emplace_back();
    for (int i = 0; i < 50; ++i) column.push_back(std::exp(-0.1 * i * (1 + static_cast<double>(c) / 20)));
  }
  return columns;
}

Column mixture(const ReducedBasis& basis, size_t c) {
  Column result(basis.functions[0].size(), 0.0);
  for (size_t k = 0; k < basis.functions.size(); ++k)
    for (size_t i = 0; i < result.size(); ++i) result[i] += basis.weights[c][k] * basis.functions[k][i];
  return result;
}

double largest_difference(const Column& a, const Column& b) {
  double result = 0;
  for (size_t i = 0; i < a.size(); ++i) result = std::max(result, std::abs(a[i] - b[i]));
  return result;
}

TEST(ReducedBasis, DescribesAllColumnsAsWellAsAskedByFewFunctions) {
  const auto columns = decays(60);
  for (const double most : {1e-2, 1e-4, 1e-6}) {
    const ReducedBasis basis = reduce_basis(columns, largest, most, 32);
    EXPECT_LE(basis.functions.size(), 12u);
    for (size_t c = 0; c < columns.size(); ++c)
      EXPECT_LE(largest_difference(mixture(basis, c), columns[c]), most * (1 + 1e-9)) << c;
  }
}

TEST(ReducedBasis, StopsAtTheMostFunctionsThatAreAllowed) {
  EXPECT_EQ(reduce_basis(decays(60), largest, 1e-12, 3).functions.size(), 3u);
}

TEST(ReducedBasis, KeepsAFewColumnsAsTheyAre) {
  const auto columns = decays(4);
  const ReducedBasis basis = reduce_basis(columns, largest, 1, 32);
  EXPECT_EQ(basis.functions, columns);
  for (size_t c = 0; c < columns.size(); ++c) EXPECT_EQ(mixture(basis, c), columns[c]);
}

TEST(ReducedBasis, HasNoFunctionsWhereAllIsZero) {
  EXPECT_TRUE(reduce_basis(std::vector(6, Column(5, 0.0)), largest, 1e-3, 32).functions.empty());
}

}  // namespace
}  // namespace frond::leaf

#include "leaf/solve/reduced_basis.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace frond::leaf {
namespace {

using Column = std::vector<double>;
using Measure = std::function<double(const Column&)>;

double dot(const Column& a, const Column& b) { return std::inner_product(a.begin(), a.end(), b.begin(), 0.0); }

void add(Column& to, double weight, const Column& function) {
  for (size_t i = 0; i < to.size(); ++i) to[i] += weight * function[i];
}

Column unit(const Column& c) {
  Column result(c.size(), 0.0);
  add(result, 1 / std::sqrt(dot(c, c)), c);
  return result;
}

ReducedBasis columns_themselves(std::vector<Column> columns) {
  ReducedBasis basis;
  for (size_t c = 0; c < columns.size(); ++c) basis.weights.emplace_back(columns.size(), 0.0)[c] = 1;
  basis.functions = std::move(columns);
  return basis;
}

/// Greedy Gram-Schmidt: the next function is the residual of the column with the largest error.
ReducedBasis greedy_basis(std::vector<Column> columns, const Measure& error, double most, size_t most_functions) {
  ReducedBasis basis;
  basis.weights.resize(columns.size());
  while (basis.functions.size() < most_functions) {
    std::vector<double> errors;
    for (const Column& c : columns) errors.push_back(error(c));
    const auto worst = std::ranges::max_element(errors);
    if (*worst == 0 || (*worst <= most && !basis.functions.empty())) break;
    const Column& function = basis.functions.emplace_back(unit(columns[static_cast<size_t>(worst - errors.begin())]));
    for (size_t c = 0; c < columns.size(); ++c) {
      const double weight = dot(function, columns[c]);
      add(columns[c], -weight, function);
      basis.weights[c].push_back(weight);
    }
  }
  return basis;
}

/// The same space by its principal axes, in order of decreasing weights.
ReducedBasis principal_basis(const ReducedBasis& basis) {
  const auto count = static_cast<Eigen::Index>(basis.functions.size());
  Eigen::MatrixXd weights(static_cast<Eigen::Index>(basis.weights.size()), count);
  for (Eigen::Index c = 0; c < weights.rows(); ++c)
    for (Eigen::Index k = 0; k < count; ++k)
      weights(c, k) = basis.weights[static_cast<size_t>(c)][static_cast<size_t>(k)];
  const Eigen::MatrixXd gram = weights.transpose() * weights;
  const Eigen::MatrixXd axes = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(gram).eigenvectors().rowwise().reverse();
  weights *= axes;
  ReducedBasis result;
  for (Eigen::Index k = 0; k < count; ++k) {
    Column& function = result.functions.emplace_back(basis.functions[0].size(), 0.0);
    for (Eigen::Index j = 0; j < count; ++j) add(function, axes(j, k), basis.functions[static_cast<size_t>(j)]);
  }
  for (Eigen::Index c = 0; c < weights.rows(); ++c) {
    const Eigen::RowVectorXd row = weights.row(c);
    result.weights.emplace_back(row.begin(), row.end());
  }
  return result;
}

/// Drops functions from the end, except the first, as long as no column's error exceeds `most`.
void shorten(ReducedBasis& basis, const Measure& error, double most) {
  size_t count = basis.functions.size();
  std::vector<Column> missing(basis.weights.size(), Column(basis.functions[0].size(), 0.0));
  while (count > 1) {
    for (size_t c = 0; c < missing.size(); ++c)
      add(missing[c], basis.weights[c][count - 1], basis.functions[count - 1]);
    if (std::ranges::any_of(missing, [&](const Column& m) { return error(m) > most; })) break;
    --count;
  }
  basis.functions.resize(count);
  for (std::vector<double>& weights : basis.weights) weights.resize(count);
}

}  // namespace

ReducedBasis reduce_basis(std::vector<Column> columns, const Measure& error, double most, size_t most_functions) {
  constexpr size_t kFew = 4;
  if (columns.size() <= kFew) return columns_themselves(std::move(columns));
  constexpr double kGreedyShare = 0.1;  // of the error: the greedy space is almost complete
  ReducedBasis greedy = greedy_basis(std::move(columns), error, kGreedyShare * most, most_functions);
  if (greedy.functions.empty()) return greedy;
  ReducedBasis basis = principal_basis(greedy);
  shorten(basis, error, (1 - kGreedyShare) * most);
  return basis;
}

}  // namespace frond::leaf

#include "leaf/table/series_lookup.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <numeric>

namespace frond::leaf {
namespace {

size_t longest_series(const std::vector<LeafModes>& modes, bool from_below, bool crosses) {
  size_t longest = 0;
  for (const LeafModes& m : modes) longest = std::max(longest, m.series(from_below, crosses).size());
  return longest;
}

/// All modes of each column in one row: [mode][node of both sines].
std::vector<std::vector<double>> rows_of(const ModeTable& spectrum, bool from_below, bool crosses, size_t modes,
                                         size_t places) {
  std::vector<std::vector<double>> rows;
  for (const LeafModes& column : spectrum.modes) {
    std::vector<double>& row = rows.emplace_back(modes * places, 0.0);
    auto to = row.begin();
    for (const LeafModes::Grid& h : column.series(from_below, crosses)) to = std::ranges::copy(h, to).out;
  }
  return rows;
}

/// Largest sum over the modes of a row: an error of pi f, since the factor before the series is at most about 1.
double largest_sum(const std::vector<double>& row, size_t places) {
  double largest = 0;
  for (size_t i = 0; i < places; ++i) {
    double sum = 0;
    for (size_t k = i; k < row.size(); k += places) sum += std::abs(row[k]);
    largest = std::max(largest, sum);
  }
  return largest * std::numbers::pi;
}

}  // namespace

SeriesLookup::SeriesLookup(const ModeTable& spectrum, bool from_below, bool crosses, double tolerance)
    : cells_(static_cast<size_t>(spectrum.cells)), modes_(longest_series(spectrum.modes, from_below, crosses)) {
  assert(modes_ <= kMostModes);
  const ReducedBasis basis = reduce_basis(
      rows_of(spectrum, from_below, crosses, modes_, cell_count()),
      [this](const std::vector<double>& row) { return largest_sum(row, cell_count()); }, tolerance, 4 * kMostBlocks);
  blocks_ = (basis.functions.size() + 3) / 4;
  set_weights(basis);
  set_needed(basis, tolerance);
  set_values(basis);
}

void SeriesLookup::set_weights(const ReducedBasis& basis) {
  weights_.resize(basis.weights.size() * blocks_);
  for (size_t c = 0; c < basis.weights.size(); ++c)
    for (size_t k = 0; k < basis.functions.size(); ++k)
      weights_[c * blocks_ + k / 4][k % 4] = static_cast<float>(basis.weights[c][k]);
}

/// Contribution to pi f, at each node, of one mode of the block's functions, in the column where it is largest.
std::vector<double> SeriesLookup::contribution_bounds(const ReducedBasis& basis, size_t block, size_t mode) const {
  const size_t first = 4 * block, end = std::min(first + 4, basis.functions.size());
  std::vector<double> sizes(cell_count(), 0.0);
  for (const std::vector<double>& weights : basis.weights)
    for (size_t i = 0; i < cell_count(); ++i) {
      double sum = 0;
      for (size_t k = first; k < end; ++k) sum += weights[k] * basis.functions[k][mode * cell_count() + i];
      sizes[i] = std::max(sizes[i], std::abs(sum) * std::numbers::pi);
    }
  return sizes;
}

/// Bound of this contribution in a cell: the absolute values of the cubics' weights sum to at most 25/16.
double SeriesLookup::neighbourhood_bound(const std::vector<double>& size, size_t incident, size_t leaving) const {
  double largest = 0;
  for (size_t i = incident; i < incident + 4; ++i)
    for (size_t o = leaving; o < leaving + 4; ++o) largest = std::max(largest, size[i * side() + o]);
  return largest * 25 / 16;
}

/// Sets the number of modes in each cell, at least one, such that the omitted ones sum to less than the tolerance over
/// all blocks.
void SeriesLookup::set_needed(const ReducedBasis& basis, double tolerance) {
  needed_.resize(cells_ * cells_ * blocks_);
  for (size_t b = 0; b < blocks_; ++b) {
    std::vector<std::vector<double>> sizes;
    for (size_t m = 0; m < modes_; ++m) sizes.push_back(contribution_bounds(basis, b, m));
    for (size_t cell = 0; cell < cells_ * cells_; ++cell) {
      size_t needed = modes_;
      double left_out = 0;
      while (needed > 1) {
        left_out += neighbourhood_bound(sizes[needed - 1], cell / cells_, cell % cells_);
        if (left_out > tolerance / static_cast<double>(blocks_)) break;
        --needed;
      }
      needed_[cell * blocks_ + b] = static_cast<uint8_t>(needed);
      most_modes_[b] = std::max(most_modes_[b], needed);
    }
    terms_ += most_modes_[b];
  }
}

void SeriesLookup::set_values(const ReducedBasis& basis) {
  values_.resize(cell_count() * terms_);
  for (size_t i = 0; i < cell_count(); ++i)
    for (size_t k = 0, before = 0; k < basis.functions.size(); ++k) {
      if (k > 0 && k % 4 == 0) before += most_modes_[k / 4 - 1];
      for (size_t m = 0; m < most_modes_[k / 4]; ++m)
        values_[i * terms_ + before + m][k % 4] = static_cast<float>(basis.functions[k][m * cell_count() + i]);
    }
}

}  // namespace frond::leaf

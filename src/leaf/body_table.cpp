#include "leaf/body_table.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <utility>

#include "leaf/fresnel.h"
#include "leaf/quadrature.h"

namespace frond::leaf {
namespace {

/// Lagrange's polynomials through -1, 0, 1, 2, at t in [0, 1].
std::array<float, 4> cubic_weights(float t) {
  const float a = t + 1, b = t - 1, c = t - 2;
  return {-t * b * c / 6, a * b * c / 2, -a * t * c / 2, a * t * b / 6};
}

size_t longest_series(const std::vector<BodyModes>& modes, bool from_below, bool crosses) {
  size_t longest = 0;
  for (const BodyModes& m : modes) longest = std::max(longest, m.series(from_below, crosses).size());
  return longest;
}

/// A way out: sine, and its weight in the integral of series / (1 - F_i) over the hemisphere.
struct Exit {
  float sine;
  double weight;
};

/// Dense at grazing, where the chance to leave is like a square root.
std::vector<Exit> exits(double index) {
  std::vector<Exit> result;
  for (const auto& [x, weight] : gauss_legendre(16)) {
    const double mu = x * x;
    const Crossing out = fresnel(mu, 1 / index);
    result.push_back({static_cast<float>(std::sqrt(1 - mu * mu)),
                      weight * 2 * x * mu * 2 * std::numbers::pi * (1 - out.reflectance) / out.cos_t});
  }
  return result;
}

}  // namespace

BodyTable::BodyTable(const BodyRequest& request, const BodySpectrum& spectrum, bool lanes_vary)
    : cells_(spectrum.cells), columns_(spectrum.modes.size()), index_(spectrum.index), depths_(request.depths) {
  if (lanes_vary) wavelengths_ = WavelengthAxis(request.wavelengths_nm);
  for (const bool from_below : {false, true})
    for (const bool crosses : {false, true}) parts_[from_below][crosses] = make_part(spectrum, from_below, crosses);
}

BodyTable::Part BodyTable::make_part(const BodySpectrum& spectrum, bool from_below, bool crosses) const {
  Part part;
  part.blocks = (longest_series(spectrum.modes, from_below, crosses) + 3) / 4;
  assert(part.blocks <= kMostBlocks);
  const size_t places = side() * side();
  part.values.resize(places * columns_ * part.blocks);
  for (size_t c = 0; c < columns_; ++c) {
    const auto& series = spectrum.modes[c].series(from_below, crosses);
    for (size_t m = 0; m < series.size(); ++m)
      for (size_t i = 0; i < places; ++i)
        part.values[(i * columns_ + c) * part.blocks + m / 4][m % 4] = static_cast<float>(series[m][i]);
  }
  add_shares(part);
  return part;
}

/// By mode 0 as it is looked up.
void BodyTable::add_shares(Part& part) const {
  for (size_t i = 0; i < side(); ++i)
    for (size_t c = 0; c < columns_; ++c) {
      double sum = 0;
      for (const auto& [sine, weight] : exits(index_of(c))) {
        const Nodes leaving = nodes(sine);
        for (size_t o = 0; o < leaving.weight.size(); ++o) {
          const size_t node = i * side() + leaving.first + o;
          sum += weight * static_cast<double>(leaving.weight[o] * part.values[(node * columns_ + c) * part.blocks][0]);
        }
      }
      part.shares.push_back(static_cast<float>(sum));
    }
}

size_t BodyTable::bytes() const {
  size_t sum = 0;
  for (const auto& lit : parts_)
    for (const Part& part : lit) sum += part.values.size() * sizeof(FourModes) + part.shares.size() * sizeof(float);
  return sum;
}

BodyTable::Selection BodyTable::select(const SampledWavelengths& lambda) const {
  return with_index(select_columns(wavelengths_, lambda));
}

BodyTable::Selection BodyTable::select(const SampledWavelengths& lambda,
                                       const std::array<double, kLanes>& optical_depth) const {
  return with_index(select_columns(wavelengths_, depths_, lambda, optical_depth));
}

BodyTable::Selection BodyTable::with_index(const TableSelection& columns) const {
  Selection selection{columns, SampledSpectrum(static_cast<float>(index_[0]))};
  for (size_t l = 0; l < static_cast<size_t>(columns.lane_count); ++l) {
    double index = 0;
    for (size_t c = 0; c < static_cast<size_t>(columns.columns_per_lane); ++c)
      index += static_cast<double>(columns.lanes[l].weight[c]) * index_of(columns.lanes[l].column[c]);
    selection.index.v[l] = static_cast<float>(index);
  }
  return selection;
}

BodyTable::Nodes BodyTable::nodes(float sine) const {
  const float x = sine * static_cast<float>(cells_);
  const int cell = std::clamp(static_cast<int>(x), 0, cells_ - 1);
  return {static_cast<size_t>(cell), cubic_weights(x - static_cast<float>(cell))};
}

BodyTable::Patch BodyTable::patch(const Nodes& incident, const Nodes& leaving) const {
  Patch patch{incident.first * side() + leaving.first, {}};
  for (size_t i = 0; i < 4; ++i)
    for (size_t o = 0; o < 4; ++o) patch.weight[i][o] = incident.weight[i] * leaving.weight[o];
  return patch;
}

/// Four sums that do not wait for each other.
BodyTable::FourModes BodyTable::sum_patch(const Part& part, const Patch& patch, size_t column, size_t block) const {
  const size_t next = columns_ * part.blocks;
  const FourModes* row = &part.values[patch.first * next + column * part.blocks + block];
  FourModes a{}, b{}, c{}, d{};
  for (const auto& [wa, wb, wc, wd] : patch.weight) {
    a += wa * row[0];
    b += wb * row[next];
    c += wc * row[2 * next];
    d += wd * row[3 * next];
    row += side() * next;
  }
  return (a + b) + (c + d);
}

float BodyTable::sum_modes(const Part& part, const Patch& patch, const TableSelection::Lane& lane, size_t columns,
                           const Modes& cosines) const {
  FourModes sum{};
  for (size_t block = 0; block < part.blocks; ++block)
    for (size_t c = 0; c < columns; ++c)
      sum += lane.weight[c] * sum_patch(part, patch, lane.column[c], block) * cosines[block];
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

SampledSpectrum BodyTable::series(bool from_below, bool crosses, const Nodes& incident, const Nodes& leaving,
                                  float cos_phi, const TableSelection& columns) const {
  const Part& part = parts_[from_below][crosses];
  Modes cosines;  // cos m phi, by Chebyshev's recurrence
  float before = cos_phi, now = 1;
  for (size_t block = 0; block < part.blocks; ++block)
    for (size_t m = 0; m < 4; ++m) {
      cosines[block][m] = now;
      before = std::exchange(now, 2 * cos_phi * now - before);
    }
  const Patch around = patch(incident, leaving);
  SampledSpectrum result;
  for (size_t lane = 0; lane < static_cast<size_t>(columns.lane_count); ++lane)
    result.v[lane] = std::max(
        0.f, sum_modes(part, around, columns.lanes[lane], static_cast<size_t>(columns.columns_per_lane), cosines));
  return result;
}

SampledSpectrum BodyTable::share(bool from_below, bool crosses, const Nodes& incident,
                                 const TableSelection& columns) const {
  const Part& part = parts_[from_below][crosses];
  SampledSpectrum result;
  for (size_t l = 0; l < static_cast<size_t>(columns.lane_count); ++l) {
    const TableSelection::Lane& lane = columns.lanes[l];
    float sum = 0;
    for (size_t c = 0; c < static_cast<size_t>(columns.columns_per_lane); ++c)
      for (size_t i = 0; i < incident.weight.size(); ++i)
        sum += lane.weight[c] * incident.weight[i] * part.shares[(incident.first + i) * columns_ + lane.column[c]];
    result.v[l] = std::max(0.f, sum);
  }
  return result;
}

}  // namespace frond::leaf

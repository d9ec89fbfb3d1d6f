#include "leaf/table/mode_lookup.h"

#include <algorithm>
#include <numeric>

#include "leaf/table/exit_weights.h"

namespace frond::leaf {
namespace {

/// Share of the tolerance for each of the two truncations of SeriesLookup.
constexpr double kTableShare = 1.0 / 8;

}  // namespace

ModeLookup::ModeLookup(const ModeTableRequest& request, const ModeTable& spectrum, bool lanes_vary)
    : cells_(static_cast<size_t>(spectrum.cells)),
      index_(spectrum.index.begin(), spectrum.index.end()),
      depths_(request.depths) {
  if (lanes_vary) wavelengths_ = WavelengthAxis(request.wavelengths_nm);
  for (const bool from_below : {false, true})
    for (const bool crosses : {false, true})
      series_[from_below][crosses] = SeriesLookup(spectrum, from_below, crosses, kTableShare * request.tolerance);
  add_ways(spectrum);
}

/// Uses mode 0, interpolated as a look-up does.
void ModeLookup::add_ways(const ModeTable& spectrum) {
  const size_t side = cells_ + 3;
  const Measure measure = spectrum.is_reciprocal ? Measure::plain : Measure::over_inner_cosine;
  for (size_t c = 0; c < index_.size(); ++c) {
    const std::vector<double> weights = exit_weights(static_cast<double>(index_[c]), cells_, measure);
    const auto share = [&](bool from_below, bool crosses, size_t incident) {
      const double* h = &spectrum.modes[c].series(from_below, crosses)[0][incident * side];
      return static_cast<float>(std::inner_product(weights.begin(), weights.end(), h, 0.0));
    };
    for (const bool below : {false, true})
      for (size_t i = 0; i < side; ++i)
        ways_[below].push_back(Float4{share(below, false, i), share(below, true, i), share(!below, true, i), 0});
  }
}

Interval ModeLookup::indices() const {
  const auto [least, most] = std::ranges::minmax_element(index_);
  return {double(*least), double(*most)};
}

size_t ModeLookup::bytes() const {
  size_t sum = 0;
  for (const bool below : {false, true}) {
    sum += ways_[below].size() * sizeof(Float4);
    for (const SeriesLookup& table : series_[below]) sum += table.bytes();
  }
  return sum;
}

ModeLookup::Selection ModeLookup::select(const SampledWavelengths& lambda) const {
  return with_index(select_columns(wavelengths_, lambda));
}

ModeLookup::Selection ModeLookup::select(const SampledWavelengths& lambda,
                                         const std::array<double, kLanes>& optical_depth) const {
  return with_index(select_columns(wavelengths_, depths_, lambda, optical_depth));
}

ModeLookup::Selection ModeLookup::with_index(const TableSelection& columns) const {
  Selection selection{columns, SampledSpectrum(index_[0])};
  for (size_t l = 0; l < static_cast<size_t>(columns.lane_count); ++l) {
    float index = 0;
    for (size_t c = 0; c < static_cast<size_t>(columns.columns_per_lane); ++c)
      index += columns.lanes[l].weight[c] * index_[columns.lanes[l].column[c]];
    selection.index[int(l)] = index;
  }
  return selection;
}

ModeLookup::Ways ModeLookup::ways(bool from_below, const Nodes& incident, Float4 light,
                                  const TableSelection& columns) const {
  Float4 sum{};
  for (size_t l = 0; l < static_cast<size_t>(columns.lane_count); ++l)
    for (size_t c = 0; c < static_cast<size_t>(columns.columns_per_lane); ++c) {
      const Float4* shares = &ways_[from_below][columns.lanes[l].column[c] * (cells_ + 3) + incident.first];
      Float4 between{};
      for (size_t i = 0; i < 4; ++i) between += incident.weight[i] * shares[i];
      sum += light[l] * columns.lanes[l].weight[c] * between;
    }
  sum = larger(sum, Float4{});
  return {sum[0], sum[1], sum[2]};
}

}  // namespace frond::leaf

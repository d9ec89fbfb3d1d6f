#include "report/excitation_emission_chart.h"

#include <fmt/format.h>

#include "core/error.h"
#include "report/polar_map.h"

namespace frond {
namespace {

constexpr size_t kMostMatrices = 6, kMostPairs = 100'000;

/// Interval of an axis that a wavelength stands for: up to the middles between it and its neighbours.
Range around(const std::vector<double>& nm, size_t i) {
  const double low = i > 0 ? (nm[i - 1] + nm[i]) / 2 : nm[0] - (nm[1] - nm[0]) / 2;
  const double high = i + 1 < nm.size() ? (nm[i] + nm[i + 1]) / 2 : nm[i] + (nm[i] - nm[i - 1]) / 2;
  return {low, high};
}

Range all_of(const std::vector<double>& nm) { return {around(nm, 0).low, around(nm, nm.size() - 1).high}; }

Panel map_of(const FluorescenceMatrix& m, Estimate FluorescenceMatrix::Cell::*side, std::string title,
             const ColorScale& scale) {
  Panel panel{470,
              380,
              std::move(title),
              {"emission (nm)", all_of(m.emission_nm)},
              {"excitation (nm)", all_of(m.excitation_nm)}};
  for (size_t e = 0; e < m.excitation_nm.size(); ++e)
    for (size_t f = 0; f < m.emission_nm.size(); ++f) {
      const Range x = around(m.emission_nm, f), y = around(m.excitation_nm, e);
      panel.series.push_back({"",
                              scale.color((m.at(e, f).*side).mean),
                              0,
                              {},
                              Mark::none,
                              0,
                              {{x.low, y.low}, {x.high, y.low}, {x.high, y.high}, {x.low, y.high}},
                              "",
                              true});
    }
  return panel;
}

}  // namespace

void check_excitation_emission_chart(size_t matrices, size_t excitations, size_t emissions) {
  if (excitations < 2 || emissions < 2)
    fail({}, "--plot draws a map over excitation and emission: at least two wavelengths of each are needed");
  if (matrices > kMostMatrices)
    fail({}, "--plot draws {} matrices at most, {} were given (materials times angles)", kMostMatrices, matrices);
  if (excitations * emissions > kMostPairs)
    fail({}, "--plot draws {} pairs of wavelengths at most, there are {} x {}", kMostPairs, excitations, emissions);
}

Chart excitation_emission_chart(const std::vector<LabelledMatrix>& matrices) {
  Range range{0, 0};
  for (const auto& [material, matrix] : matrices)
    for (const FluorescenceMatrix::Cell& cell : matrix.cells)
      range.include(cell.lit_side.mean), range.include(cell.opposite_side.mean);
  const ColorScale scale{{"photons per nm and incident photon", range.high > 0 ? range : Range{0, 1}}};
  Chart chart{3};
  for (const auto& [material, matrix] : matrices) {
    const std::string light = fmt::format("other side (Mf), light at {:g}°", matrix.theta_deg);
    chart.panels.push_back(map_of(matrix, &FluorescenceMatrix::Cell::lit_side, "lit side (Mb): " + material, scale));
    chart.panels.push_back(map_of(matrix, &FluorescenceMatrix::Cell::opposite_side, light, scale));
    chart.panels.push_back(scale.panel(380));
  }
  return chart;
}

}  // namespace frond

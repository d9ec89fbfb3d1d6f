#include "leaf/table/mode_table.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace frond::leaf {
namespace {

/// Largest fourth difference along a row or a column of the grid: about node i, from `at(i - 2)` to `at(i + 2)`.
template <class At>
double fourth_difference(const At& at, size_t i) {
  return at(i - 2) - 4 * at(i - 1) + 6 * at(i) - 4 * at(i + 1) + at(i + 2);
}

double cosine(double sine) { return std::sqrt(std::max(0.0, 1 - sine * sine)); }

/// In the middle of a cell the cubic through four points has an error of 3/128 of the fourth difference.
constexpr double kMiddle = 3.0 / 128;

/// Error of pi f, summed over the modes.
double interpolation_error(const std::vector<LeafModes::Grid>& series, const std::vector<double>& sines,
                           const Tissue& tissue) {
  const size_t count = sines.size();
  double largest = 0;
  for (size_t i = 2; i + 2 < count; ++i)
    for (size_t o = 2; o + 2 < count; ++o) {
      double sum = 0;
      for (const LeafModes::Grid& h : series)
        sum += std::abs(fourth_difference([&](size_t k) { return h[k * count + o]; }, i)) +
               std::abs(fourth_difference([&](size_t k) { return h[i * count + k]; }, o));
      largest = std::max(largest, sum * interface_transmittance(tissue, cosine(sines[i]), cosine(sines[o])));
    }
  return largest * kMiddle * std::numbers::pi;
}

double interpolation_error(const LeafModes& modes, const Tissue& tissue) {
  double largest = 0;
  for (const bool from_below : {false, true})
    for (const bool crosses : {false, true})
      largest = std::max(largest, interpolation_error(modes.series(from_below, crosses), modes.sines(), tissue));
  return largest;
}

/// The leaf in each column of the table.
std::vector<Tissue> tissues_of(const ModeTableRequest& request, const TissueModel& model) {
  std::vector<Tissue> tissues;
  for (const double nm : request.wavelengths_nm) {
    if (request.depths.empty()) tissues.push_back(model.at(nm));
    for (const double depth : request.depths.depths()) tissues.push_back(model.at(nm, depth, model.lobes()));
  }
  return tissues;
}

LeafModes solve(const ModeTableRequest& request, const Tissue& tissue, int cells) {
  const int nodes = request.nodes > 0 ? request.nodes : mode_nodes(tissue);
  return solve_modes(tissue, grid_sines(cells), request.tolerance, nodes);
}

/// Number of cells for an error of half the tolerance (the other half is for missing modes), given the error with
/// `cells`: it falls with their fourth power.
int cells_for(double tolerance, int cells, double error) {
  constexpr int kLeast = 4;
  const double wish = cells * std::pow(2 * error / tolerance, 0.25);
  return static_cast<int>(std::clamp<double>(std::ceil(wish), kLeast, kMostCells));
}

/// Judged by the column that absorbs least, where f is largest.
int first_guess(const ModeTableRequest& request, const std::vector<Tissue>& tissues) {
  constexpr int kCells = 8;
  const Tissue& tissue = *std::ranges::min_element(tissues, {}, &Tissue::mesophyll_depth);
  return cells_for(request.tolerance, kCells, interpolation_error(solve(request, tissue, kCells), tissue));
}

}  // namespace

std::vector<double> grid_sines(int cells) {
  std::vector<double> sines;
  for (int i = -1; i <= cells + 1; ++i) sines.push_back(static_cast<double>(i) / cells);
  return sines;
}

ModeTable make_mode_table(const ModeTableRequest& request, const ThreadPool& pool) {
  const TissueModel model(request.params);
  const std::vector<Tissue> tissues = tissues_of(request, model);
  ModeTable spectrum{.cells = first_guess(request, tissues)};
  for (const Tissue& tissue : tissues) spectrum.index.push_back(tissue.n_cuticle());
  spectrum.modes.resize(tissues.size());
  std::vector<double> errors(tissues.size());
  for (;;) {
    pool.for_each(static_cast<int64_t>(tissues.size()), [&](int64_t index, int) {
      const auto i = static_cast<size_t>(index);
      spectrum.modes[i] = solve(request, tissues[i], spectrum.cells);
      errors[i] = interpolation_error(spectrum.modes[i], tissues[i]);
    });
    spectrum.error = *std::ranges::max_element(errors);
    if (spectrum.error <= request.tolerance / 2 || spectrum.cells == kMostCells) return spectrum;
    spectrum.cells = std::max(spectrum.cells + 1, cells_for(request.tolerance, spectrum.cells, spectrum.error));
  }
}

}  // namespace frond::leaf

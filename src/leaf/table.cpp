#include "leaf/table.h"

#include <algorithm>
#include <bit>
#include <numbers>

#include "leaf/walk.h"

namespace frond::leaf {
namespace {

/// The paper's virtual spectrophotometer: counts of where rays go.
Shares measure(const Tissue& tissue, size_t degree, int rays, RandomStream rng) {
  if (degree == 90) return {.surface = 1};  // Fresnel's limit at grazing; a ray along the leaf never meets it
  const double theta = static_cast<double>(degree) * std::numbers::pi / 180;
  const Vec3d wo{std::sin(theta), 0, std::cos(theta)};
  int surface = 0, subsurface = 0, transmitted = 0;
  for (int i = 0; i < rays; ++i) {
    const Fate fate = walk(tissue, wo, Absorption::analog, rng).fate;
    surface += fate == Fate::surface;
    subsurface += fate == Fate::reflected;
    transmitted += fate == Fate::transmitted;
  }
  return {1.0 * surface / rays, 1.0 * subsurface / rays, 1.0 * transmitted / rays};
}

double largest_standard_error(const std::vector<Shares>& shares, int rays) {
  const auto variance = [](double p) { return p * (1 - p); };
  double largest = 0;
  for (const Shares& s : shares)
    largest = std::max({largest, variance(s.surface), variance(s.subsurface), variance(s.transmitted)});
  return std::sqrt(largest / rays);
}

double largest_difference(const std::vector<Shares>& a, const std::vector<Shares>& b) {
  double largest = 0;
  for (size_t i = 0; i < a.size(); ++i)
    largest = std::max({largest, std::abs(a[i].surface - b[i].surface), std::abs(a[i].subsurface - b[i].subsurface),
                        std::abs(a[i].transmitted - b[i].transmitted)});
  return largest;
}

std::vector<double> all_degrees() {
  std::vector<double> degrees(Table::kDegrees);
  for (size_t i = 0; i < degrees.size(); ++i) degrees[i] = static_cast<double>(i);
  return degrees;
}

void fill_by_monte_carlo(Table& table, const TissueModel& model, const TableRequest& request, const ThreadPool& pool) {
  pool.for_each(static_cast<int64_t>(table.shares.size()), [&](int64_t index, int) {
    const auto i = static_cast<size_t>(index);
    const size_t degree = i % Table::kDegrees;
    const double lambda_nm = table.wavelengths_nm[i / Table::kDegrees];
    const RandomStream rng(hash_key(request.seed, std::bit_cast<uint64_t>(lambda_nm), degree));
    table.shares[i] = measure(model.at(lambda_nm), degree, request.rays, rng);
  });
  table.error = largest_standard_error(table.shares, request.rays);
}

void fill_by_solving(Table& table, const TissueModel& model, const ThreadPool& pool) {
  const std::vector<double> degrees = all_degrees();
  const size_t count = table.wavelengths_nm.size();
  pool.for_each(static_cast<int64_t>(count), [&](int64_t index, int) {
    const auto i = static_cast<size_t>(index);
    const std::vector<Shares> column = solve(model.at(table.wavelengths_nm[i]), degrees);
    std::copy(column.begin(), column.end(), table.shares.begin() + static_cast<ptrdiff_t>(i * Table::kDegrees));
  });
  // The error is judged at one wavelength, by half as many nodes again.
  const auto middle = table.shares.begin() + static_cast<ptrdiff_t>(count / 2 * Table::kDegrees);
  const std::vector<Shares> finer = solve(model.at(table.wavelengths_nm[count / 2]), degrees, kSolverNodes * 3 / 2);
  table.error = largest_difference({middle, middle + Table::kDegrees}, finer);
}

}  // namespace

Table make_table(const TableRequest& request, const ThreadPool& pool) {
  Table table{request.wavelengths_nm, std::vector<Shares>(request.wavelengths_nm.size() * Table::kDegrees), 0};
  if (table.shares.empty()) return table;
  const TissueModel model(request.params);
  if (request.method == TableMethod::monte_carlo)
    fill_by_monte_carlo(table, model, request, pool);
  else
    fill_by_solving(table, model, pool);
  return table;
}

}  // namespace frond::leaf

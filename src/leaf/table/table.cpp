#include "leaf/table/table.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <numbers>
#include <numeric>
#include <set>

#include "core/parallel.h"
#include "leaf/walk/batch_walk.h"

namespace frond::leaf {
namespace {

/// The paper's virtual spectrophotometer: counts rays by their fate.
Shares measure(const Tissue& tissue, double theta_deg, int rays, uint64_t key) {
  if (theta_deg == 90) return {.surface = 1};  // Fresnel's limit at grazing; a ray along the leaf never meets it
  const double theta = theta_deg * std::numbers::pi / 180;
  const Vec3d wo{std::sin(theta), 0, std::cos(theta)};
  std::array<int, 4> counts{};  // by Fate
  std::array<BatchRay, 4096> batch;
  const auto all = static_cast<size_t>(rays);
  for (size_t first = 0; first < all; first += batch.size()) {
    check_stop();
    const std::span<BatchRay> some(batch.data(), std::min(batch.size(), all - first));
    walk_batch(tissue, wo, Absorption::analog, key, some, first);
    for (const BatchRay& ray : some) ++counts[static_cast<size_t>(ray.fate)];
  }
  const auto share = [&](Fate fate) { return 1.0 * counts[static_cast<size_t>(fate)] / rays; };
  return {share(Fate::surface), share(Fate::reflected), share(Fate::transmitted)};
}

Shares standard_error(const Shares& s, int rays) {
  const auto of = [rays](double p) { return std::sqrt(p * (1 - p) / rays); };
  return {of(s.surface), of(s.subsurface), of(s.transmitted)};
}

double largest_difference(std::span<const Shares> a, std::span<const Shares> b) {
  double largest = 0;
  for (size_t i = 0; i < a.size(); ++i)
    largest = std::max({largest, std::abs(a[i].surface - b[i].surface), std::abs(a[i].subsurface - b[i].subsurface),
                        std::abs(a[i].transmitted - b[i].transmitted)});
  return largest;
}

void fill_by_monte_carlo(Table& table, const TissueModel& model, const TableRequest& request, const ThreadPool& pool) {
  const size_t angles = table.theta_deg.size();
  table.standard_errors.resize(table.shares.size());
  pool.for_each(static_cast<int64_t>(table.shares.size()), [&](int64_t index, int) {
    const auto i = static_cast<size_t>(index);
    const double theta_deg = table.theta_deg[i % angles], lambda_nm = table.wavelengths_nm[i / angles];
    const uint64_t key = hash_key(request.seed, std::bit_cast<uint64_t>(lambda_nm), std::bit_cast<uint64_t>(theta_deg));
    table.shares[i] = measure(model.at(lambda_nm), theta_deg, request.rays, key);
    table.standard_errors[i] = standard_error(table.shares[i], request.rays);
  });
  table.error = largest_difference(table.standard_errors, std::vector<Shares>(table.shares.size()));
}

/// Indices of the first, middle and last wavelength, where the error of solutions is estimated.
std::vector<size_t> samples_of(size_t count) {
  const std::set<size_t> samples{0, count / 2, count - 1};
  return {samples.begin(), samples.end()};
}

void fill_by_solving(Table& table, const TissueModel& model, int asked_nodes, const ThreadPool& pool) {
  const auto nodes = [&](const Tissue& tissue) { return asked_nodes > 0 ? asked_nodes : solver_nodes(tissue); };
  const size_t angles = table.theta_deg.size(), count = table.wavelengths_nm.size();
  const std::vector<size_t> judged = samples_of(count);
  std::vector<std::vector<Shares>> finer(judged.size());
  pool.for_each(static_cast<int64_t>(judged.size() + count), [&](int64_t index, int) {
    const auto i = static_cast<size_t>(index);
    if (i < judged.size()) {
      const Tissue tissue = model.at(table.wavelengths_nm[judged[i]]);
      finer[i] = solve(tissue, table.theta_deg, (nodes(tissue) * 3 + 1) / 2);
      return;
    }
    const size_t w = i - judged.size();
    const Tissue tissue = model.at(table.wavelengths_nm[w]);
    const std::vector<Shares> column = solve(tissue, table.theta_deg, nodes(tissue));
    std::copy(column.begin(), column.end(), table.shares.begin() + static_cast<ptrdiff_t>(w * angles));
  });
  for (size_t i = 0; i < judged.size(); ++i)
    table.error = std::max(table.error,
                           largest_difference(std::span(table.shares).subspan(judged[i] * angles, angles), finer[i]));
}

Shares blend(const Shares& a, const Shares& b, double t) {
  return {std::lerp(a.surface, b.surface, t), std::lerp(a.subsurface, b.subsurface, t),
          std::lerp(a.transmitted, b.transmitted, t)};
}

/// Indices of the wavelengths, shortest first.
std::vector<size_t> ascending(const std::vector<double>& wavelengths_nm) {
  std::vector<size_t> order(wavelengths_nm.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::ranges::sort(order, {}, [&](size_t i) { return wavelengths_nm[i]; });
  return order;
}

}  // namespace

std::vector<double> even_steps(double first, double last, double step) {
  assert(step > 0);
  std::vector<double> values;
  const auto count = static_cast<int64_t>(std::floor((last - first) / step + 1e-6));
  for (int64_t i = 0; i <= count; ++i) values.push_back(first + static_cast<double>(i) * step);
  return values;
}

Table make_table(const TableRequest& request, const ThreadPool& pool) {
  Table table{.theta_deg = request.theta_deg, .wavelengths_nm = request.wavelengths_nm};
  table.shares.resize(request.wavelengths_nm.size() * request.theta_deg.size());
  if (table.shares.empty()) return table;
  const TissueModel model(request.params);
  if (request.method == TableMethod::monte_carlo)
    fill_by_monte_carlo(table, model, request, pool);
  else
    fill_by_solving(table, model, request.nodes, pool);
  return table;
}

Table mean_of_sides(const Table& table) {
  const auto middle = std::upper_bound(table.theta_deg.begin(), table.theta_deg.end(), 90.0);
  const auto kept = static_cast<size_t>(middle - table.theta_deg.begin()), all = table.theta_deg.size();
  Table mean{
      .theta_deg = {table.theta_deg.begin(), middle}, .wavelengths_nm = table.wavelengths_nm, .error = table.error};
  const auto both = [&](const std::vector<Shares>& from, size_t w, size_t i) {
    return std::array{from[w * all + i], from[w * all + all - 1 - i]};
  };
  const auto of_mean = [](double a, double b) { return std::hypot(a, b) / 2; };
  for (size_t w = 0; w < table.wavelengths_nm.size(); ++w)
    for (size_t i = 0; i < kept; ++i) {
      const auto [a, b] = both(table.shares, w, i);
      mean.shares.push_back(blend(a, b, 0.5));
      if (table.standard_errors.empty()) continue;
      const auto [e, f] = both(table.standard_errors, w, i);
      mean.standard_errors.push_back(
          {of_mean(e.surface, f.surface), of_mean(e.subsurface, f.subsurface), of_mean(e.transmitted, f.transmitted)});
    }
  return mean;
}

Table at_wavelengths(const Table& table, const std::vector<double>& wavelengths_nm) {
  const size_t angles = table.theta_deg.size();
  const std::vector<size_t> order = ascending(table.wavelengths_nm);
  Table result{.theta_deg = table.theta_deg, .wavelengths_nm = wavelengths_nm, .error = table.error};
  for (const double nm : wavelengths_nm) {
    const auto after = std::ranges::upper_bound(order, nm, {}, [&](size_t i) { return table.wavelengths_nm[i]; });
    const size_t above = std::min(static_cast<size_t>(after - order.begin()), order.size() - 1);
    const size_t b = order[above], a = order[above > 0 ? above - 1 : 0];
    const double width = table.wavelengths_nm[b] - table.wavelengths_nm[a];
    const double t = width > 0 ? std::clamp((nm - table.wavelengths_nm[a]) / width, 0.0, 1.0) : 0;
    for (size_t i = 0; i < angles; ++i) result.shares.push_back(blend(table.at(a, i), table.at(b, i), t));
  }
  return result;
}

}  // namespace frond::leaf

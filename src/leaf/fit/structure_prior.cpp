#include "leaf/fit/structure_prior.h"

#include <algorithm>
#include <cmath>

#include "leaf/fit/fit.h"

namespace frond::leaf {

namespace {

/// A share lies between 0 and 1, near either of which its logarithm says little.
bool is_share(const LeafNumber& n) { return n.is_structure() && n.range.max == 1; }

}  // namespace

const std::vector<const LeafNumber*>& prior_numbers() {
  static const std::vector<const LeafNumber*> numbers = [] {
    std::vector<const LeafNumber*> all;
    for (const LeafNumber& n : fit_variables())
      if (n.is_structure() || (n.absorbs() && !n.published && !n.prospect && n.spectrum.empty())) all.push_back(&n);
    return all;
  }();
  return numbers;
}

std::vector<double> prior_coordinates(const TissueParams& p) {
  std::vector<double> at;
  for (const LeafNumber* n : prior_numbers()) {
    const double value = n->value(p);
    at.push_back(is_share(*n) ? value : std::log(n->absorbs() ? area_content(p, value) : value));
  }
  return at;
}

std::optional<double> StructurePrior::relative_deviation(const LeafNumber& number, double value) const {
  const auto found = std::ranges::find(prior_numbers(), &number);
  if (found == prior_numbers().end()) return {};
  const double of_coordinate = deviation[static_cast<size_t>(found - prior_numbers().begin())];
  return is_share(number) ? of_coordinate / value : of_coordinate;
}

double StructurePrior::variance(double step_nm) const {
  const double rho = std::exp(-step_nm / reach_nm);
  return error * error * (1 + rho) / (1 - rho);
}

StructurePrior learn_prior(std::span<const FitRequest> leaves, std::string source) {
  // Least deviation of a coordinate: that of a number which the fits of R and T themselves hardly determine.
  constexpr double kLeast = 0.05;
  const auto n = static_cast<double>(leaves.size());
  const size_t count = prior_numbers().size();
  StructurePrior prior{std::move(source), std::vector<double>(count), std::vector<double>(count)};
  std::vector<std::vector<double>> all;
  FitCache cache;
  for (FitRequest request : leaves) {
    request.structure = Structure::bifacial, request.sieve = true;
    const FitResult fit = fit_leaf(request, ThreadPool(1), &cache);
    all.push_back(prior_coordinates(fit.params));
    prior.error += fit.rmse * fit.rmse / n, prior.reach_nm += fit.reach_nm / n;
  }
  prior.error = std::sqrt(prior.error);
  for (size_t i = 0; i < count; ++i) {
    double square = 0;
    for (const auto& x : all) prior.mean[i] += x[i] / n;
    for (const auto& x : all) square += (x[i] - prior.mean[i]) * (x[i] - prior.mean[i]) / (n - 1);
    // Another leaf also varies by the uncertainty of the mean.
    prior.deviation[i] = std::sqrt(square * (1 + 1 / n) + kLeast * kLeast);
  }
  return prior;
}

const StructurePrior& built_in_prior() {
  // By learn_prior, of five leaves of LOPEX93 and two of the University of California, Davis.
  static const StructurePrior prior{.source = "seven leaves of LOPEX93 and Davis",
                                    .mean = {-4.302, 0.866, 1.08, 1.396, 0.1674, 0.0668},
                                    .deviation = {0.3798, 0.839, 1.916, 1.416, 0.1887, 0.1098},
                                    .error = 0.01156,
                                    .reach_nm = 78.1};
  return prior;
}

const StructurePrior* used_prior(const FitRequest& request) {
  const auto is_measured = [&](std::optional<double> LeafMeasurement::*share) {
    return std::ranges::any_of(request.measurements, [share](const auto& m) { return (m.*share).has_value(); });
  };
  const bool is_of_kind = request.structure.value_or(Structure::bifacial) == Structure::bifacial &&
                          request.sieve.value_or(true) && request.absorption_tables == AbsorptionTables::prospect;
  const bool is_needed = !(is_measured(&LeafMeasurement::r) && is_measured(&LeafMeasurement::t));
  return is_of_kind && is_needed && !request.has_prior ? request.structure_prior : nullptr;
}

}  // namespace frond::leaf

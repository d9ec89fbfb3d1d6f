#include "spectra/tabulated.h"

#include <cassert>
#include <limits>

#include "spectra/analytic.h"

namespace frond {
namespace {

bool is_constant(std::span<const SpectrumPoint> points) {
  return std::all_of(points.begin(), points.end(), [&](const auto& p) { return p.value == points[0].value; });
}

/// Longest wavelength of a table that make_tabulated resamples to 1 nm: limits the memory that a mistyped wavelength
/// uses.
constexpr double kLongestDense_nm = 10000;

bool lies_on_whole_nanometres(std::span<const SpectrumPoint> points) {
  return points.back().lambda_nm <= kLongestDense_nm && std::all_of(points.begin(), points.end(), [](const auto& p) {
           return p.lambda_nm == std::floor(p.lambda_nm);
         });
}

}  // namespace

void check_points(std::span<const SpectrumPoint> points) {
  if (points.size() < 2)
    fail(points.empty() ? Location{} : points[0].where, "a spectrum needs two wavelengths at least, {} given",
         points.size());
  double last = 0;
  for (const auto& [lambda_nm, value, where] : points) {
    if (!std::isfinite(lambda_nm) || lambda_nm <= 0) fail(where, "{} is not a wavelength in nm", lambda_nm);
    if (lambda_nm <= last) fail(where, "wavelengths must ascend, {} nm follows {} nm", lambda_nm, last);
    if (!std::isfinite(value)) fail(where, "the value at {} nm is {}, finite numbers are needed", lambda_nm, value);
    constexpr double kMost = std::numeric_limits<float>::max();
    if (lambda_nm > kMost || value > kMost)
      fail(where, "{} at {} nm is beyond the largest number of 32 bits, {:.3g}", value, lambda_nm, kMost);
    if (value < 0) fail(where, "the value at {} nm is {}, a spectrum cannot be negative", lambda_nm, value);
    last = lambda_nm;
  }
  if (last < kLeast_nm)
    fail(points[0].where, "the wavelengths are from {} to {}: are these micrometres? frond takes nm",
         points[0].lambda_nm, last);
}

TabulatedSpectrum::TabulatedSpectrum(std::span<const SpectrumPoint> points) {
  check_points(points);
  for (const SpectrumPoint& p : points) {
    lambda_nm_.push_back(static_cast<float>(p.lambda_nm));
    values_.push_back(static_cast<float>(p.value));
  }
}

float TabulatedSpectrum::at(float lambda_nm) const {
  // Outside the points the value at the nearest end is returned, as Spectrum requires.
  const auto above = std::upper_bound(lambda_nm_.begin(), lambda_nm_.end(), lambda_nm);
  if (above == lambda_nm_.begin()) return values_.front();
  if (above == lambda_nm_.end()) return values_.back();
  const size_t i = static_cast<size_t>(above - lambda_nm_.begin());
  const float t = (lambda_nm - lambda_nm_[i - 1]) / (lambda_nm_[i] - lambda_nm_[i - 1]);
  return values_[i - 1] + t * (values_[i] - values_[i - 1]);
}

float TabulatedSpectrum::max_value() const { return *std::max_element(values_.begin(), values_.end()); }

DenseSpectrum::DenseSpectrum(int first_nm, std::vector<float> values)
    : first_nm_(static_cast<float>(first_nm)),
      last_(static_cast<float>(values.size()) - 1),
      values_(std::move(values)) {
  assert(values_.size() >= 2);
}

DenseSpectrum sample_densely(const Spectrum& s, int first_nm, int last_nm) {
  std::vector<float> values;
  for (int nm = first_nm; nm <= last_nm; ++nm) values.push_back(s.at(static_cast<float>(nm)));
  return {first_nm, std::move(values)};
}

SpectrumPtr make_tabulated(std::span<const SpectrumPoint> points) {
  TabulatedSpectrum table(points);
  if (is_constant(points))
    return std::make_shared<ConstantSpectrum>(static_cast<float>(points[0].value), table.range_nm());
  if (!lies_on_whole_nanometres(points)) return std::make_shared<TabulatedSpectrum>(std::move(table));
  return std::make_shared<DenseSpectrum>(
      sample_densely(table, static_cast<int>(points.front().lambda_nm), static_cast<int>(points.back().lambda_nm)));
}

SpectrumPtr make_tabulated(std::span<const double> pairs, const Location& where) {
  if (pairs.size() % 2 != 0)
    fail(where, "a spectrum is pairs of wavelength and value, {} numbers were given", pairs.size());
  if (pairs.empty()) fail(where, "a spectrum needs two wavelengths at least, 0 given");
  std::vector<SpectrumPoint> points;
  for (size_t i = 0; i < pairs.size(); i += 2) points.push_back({pairs[i], pairs[i + 1], where});
  return make_tabulated(points);
}

}  // namespace frond

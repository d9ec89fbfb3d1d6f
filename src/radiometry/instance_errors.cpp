#include "radiometry/instance_errors.h"

#include <algorithm>
#include <cmath>

#include "spectra/wavelengths/band_label.h"

namespace frond {
namespace {

/// `share(i)`: share that instance i absorbs. An instance is dark if it absorbs less than kDark of the light on a
/// horizontal surface of its area: rounding errors alone can have this size.
template <class Share>
InstanceErrors errors_of(std::string light, const FluxMeasurement& measurement, const Share& share) {
  constexpr double kDark = 1e-4;
  std::vector<double> relative;
  for (size_t i = 0; i < measurement.areas.size(); ++i) {
    const MeanError s = share(i);
    const bool is_dark = s.mean + 2 * s.standard_error < kDark * double(measurement.areas[i]) / measurement.target_area;
    if (std::isfinite(s.standard_error) && !is_dark)
      relative.push_back(s.mean > 0 ? s.standard_error / s.mean : HUGE_VAL);
  }
  InstanceErrors errors{std::move(light)};
  errors.known = relative.size();
  if (relative.empty()) return errors;
  const auto middle = relative.begin() + ptrdiff_t(relative.size() / 2);
  std::ranges::nth_element(relative, middle);
  errors.median = *middle;
  errors.largest = *std::max_element(middle, relative.end());
  return errors;
}

}  // namespace

double FluxMeasurement::error() const {
  double squares = 0;
  size_t count = 0;
  const auto add = [&](const std::vector<MeanError>& shares) {
    for (const MeanError& s : shares) squares += s.standard_error * s.standard_error, ++count;
  };
  add(reflected);
  for (const OfMaterial& m : materials)
    if (m.is_hit) add(m.absorbed);
  return count == 0 ? 0 : std::sqrt(squares / double(count));
}

InstanceErrors instance_errors(const FluxMeasurement& measurement, const std::optional<PhotonWeights>& photons) {
  const size_t bands = measurement.bands.size();
  const std::span<const MeanError> shares(measurement.by_organ);
  if (photons)
    return errors_of("PAR photons", measurement,
                     [&](size_t i) { return photons->share(shares.subspan(i * bands, bands)); });
  InstanceErrors worst;
  for (size_t band = 0; band < bands; ++band) {
    InstanceErrors errors = errors_of("light " + place_of(measurement.bands[band]), measurement,
                                      [&](size_t i) { return shares[i * bands + band]; });
    if (worst.known == 0 || errors.median > worst.median) worst = std::move(errors);
  }
  return worst;
}

}  // namespace frond

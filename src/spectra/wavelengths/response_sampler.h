#pragma once

#include <span>
#include <vector>

#include "core/error.h"
#include "core/spectrum.h"
#include "core/wavelengths.h"

namespace frond {

/// Samples wavelengths with a density proportional to a sensor's response, by inversion of its integral. Thread-safe.
class ResponseSampler {
 public:
  /// The response is linear between the points, whose wavelengths ascend, and 0 beyond them. Throws InputError at
  /// `where` if it is 0 everywhere.
  ResponseSampler(std::vector<ResponsePoint> points, const Location& where);

  /// Returns a wavelength (nm) for a uniform u in [0, 1]; its density is the response divided by its integral.
  float sample(float u) const;
  /// Interval (nm) that contains all samples.
  Interval support_nm() const { return support_nm_; }
  /// Mean wavelength (nm), weighted by the response.
  double centroid_nm() const { return centroid_nm_; }
  /// Integral of the response over the wavelength.
  double integral() const { return cumulative_.back(); }

 private:
  std::vector<ResponsePoint> points_;
  std::vector<double> cumulative_;  ///< integral of the response up to the end of each cell between two points
  Interval support_nm_{};
  double centroid_nm_ = 0;
};

/// Returns the product of a response and a light's spectrum as points to interpolate between. The integral over any
/// interval of 1 nm or more is within 1e-6 of the product's integral, relative to the largest product. Empty if the
/// product is 0 everywhere.
std::vector<ResponsePoint> lit_response(std::span<const ResponsePoint> response, const Spectrum& light);

/// Returns the mean of a spectrum under a response: the integral of their product, over that of the response.
double mean_under(std::span<const ResponsePoint> response, const Spectrum& spectrum);

/// Returns the points without the zeros at either end, except the innermost one on each side. Sensor tables are often
/// padded with zeros, which would widen the support. Empty if all values are 0.
std::vector<ResponsePoint> without_margins(std::span<const ResponsePoint> points);

}  // namespace frond

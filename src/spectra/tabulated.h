#pragma once

#include <span>
#include <vector>

#include "core/error.h"
#include "core/spectrum.h"

namespace frond {

/// Entry of a tabulated spectrum.
struct SpectrumPoint {
  double lambda_nm, value;
  Location where = {};  ///< position in the file, for error messages
};

/// Wavelengths below this one are taken to be in micrometres.
inline constexpr double kLeast_nm = 100;

/// Throws InputError at the position of the first fault unless there are at least two points, wavelengths are positive
/// and strictly ascend, not all of them are below kLeast_nm, and values are finite and not negative.
void check_points(std::span<const SpectrumPoint> points);

/// Spectrum that is linear between points of any spacing. A look-up is a binary search.
class TabulatedSpectrum final : public Spectrum {
 public:
  /// Throws as check_points does.
  explicit TabulatedSpectrum(std::span<const SpectrumPoint> points);
  float at(float lambda_nm) const override;
  Interval range_nm() const override { return {double(lambda_nm_.front()), double(lambda_nm_.back())}; }
  float max_value() const override;
  /// Wavelengths of the points.
  std::span<const float> lambda_nm() const { return lambda_nm_; }

 private:
  std::vector<float> lambda_nm_, values_;
};

/// Spectrum that is linear between values 1 nm apart. A look-up takes constant time, whatever the table's length.
class DenseSpectrum final : public Spectrum {
 public:
  /// `values` at first_nm, first_nm + 1, ...; at least two.
  DenseSpectrum(int first_nm, std::vector<float> values);
  float at(float lambda_nm) const override {
    const float x = std::clamp(lambda_nm - first_nm_, 0.f, last_);
    const size_t i = std::min(static_cast<size_t>(x), values_.size() - 2);
    const float t = x - static_cast<float>(i);
    return values_[i] + t * (values_[i + 1] - values_[i]);
  }
  SampledSpectrum sample(const SampledWavelengths& lambda) const override { return sample_lanes(*this, lambda); }
  Interval range_nm() const override { return {double(first_nm_), double(first_nm_) + double(last_)}; }
  float max_value() const override { return *std::max_element(values_.begin(), values_.end()); }

 private:
  float first_nm_, last_;
  std::vector<float> values_;
};

/// Returns the values of `s` at each whole nanometre from first_nm to last_nm, inclusive.
DenseSpectrum sample_densely(const Spectrum& s, int first_nm, int last_nm);

/// Returns the fastest spectrum that is exactly linear between the points: constant, dense (all wavelengths whole
/// nanometres) or tabulated. Throws as check_points does.
SpectrumPtr make_tabulated(std::span<const SpectrumPoint> points);

/// Returns the same from a flat list (wavelength, value, ...) of a scene file. Throws InputError at `where`.
SpectrumPtr make_tabulated(std::span<const double> pairs, const Location& where);

}  // namespace frond

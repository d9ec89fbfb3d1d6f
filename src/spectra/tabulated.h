#pragma once

#include <span>
#include <vector>

#include "core/error.h"
#include "core/spectrum.h"

namespace frond {

/// One entry of a tabulated spectrum, and where a file has it.
struct SpectrumPoint {
  double lambda_nm, value;
  Location where = {};
};

/// Throws InputError unless there are two points at least, wavelengths are positive and ascend, and values are finite
/// and not negative.
void check_points(std::span<const SpectrumPoint> points);

/// Linear between its points, whatever their spacing.
class TabulatedSpectrum final : public Spectrum {
 public:
  /// Throws as check_points does.
  explicit TabulatedSpectrum(std::span<const SpectrumPoint> points);
  float at(float lambda_nm) const override;
  Interval range_nm() const override { return {double(lambda_nm_.front()), double(lambda_nm_.back())}; }
  float max_value() const override;

 private:
  std::vector<float> lambda_nm_, values_;
};

/// Linear between values that stand 1 nm apart: a look-up costs the same however long the table.
class DenseSpectrum final : public Spectrum {
 public:
  /// `values` for first_nm, first_nm + 1, ...; two at least.
  DenseSpectrum(int first_nm, std::vector<float> values);
  float at(float lambda_nm) const override {
    const float x = std::clamp(lambda_nm - first_nm_, 0.f, last_);
    const size_t i = std::min(static_cast<size_t>(x), values_.size() - 2);
    const float t = x - static_cast<float>(i);
    return values_[i] + t * (values_[i + 1] - values_[i]);
  }
  SampledSpectrum sample(const SampledWavelengths& lambda) const override { return sample_by(*this, lambda); }
  Interval range_nm() const override { return {double(first_nm_), double(first_nm_) + double(last_)}; }
  float max_value() const override { return *std::max_element(values_.begin(), values_.end()); }

 private:
  float first_nm_, last_;
  std::vector<float> values_;
};

/// `s` at each whole nanometre from first_nm to last_nm.
DenseSpectrum sample_densely(const Spectrum& s, int first_nm, int last_nm);

/// The fastest spectrum that is exactly linear between the points. Throws as TabulatedSpectrum does.
SpectrumPtr make_tabulated(std::span<const SpectrumPoint> points);

/// The same from a flat list (wavelength, value, ...), as a scene file gives it at `where`.
SpectrumPtr make_tabulated(std::span<const double> pairs, const Location& where);

}  // namespace frond

#pragma once

#include <algorithm>
#include <limits>

#include "core/error.h"
#include "core/spectrum.h"

namespace frond {

/// Range (nm) of spectra that are given by a formula: every wavelength.
inline constexpr Interval kEveryWavelength{1, std::numeric_limits<double>::infinity()};

/// Constant spectrum: the same value at every wavelength (equal-energy spectrum if it is an emission).
class ConstantSpectrum final : public Spectrum {
 public:
  explicit ConstantSpectrum(float value, Interval range_nm = kEveryWavelength) : value_(value), range_nm_(range_nm) {}
  float at(float) const override { return value_; }
  SampledSpectrum sample(const SampledWavelengths& lambda) const override { return sample_lanes(*this, lambda); }
  Interval range_nm() const override { return range_nm_; }
  float max_value() const override { return value_; }

 private:
  float value_;
  Interval range_nm_;
};

/// Blackbody by Planck's law, scaled so that its maximum over all wavelengths is 1 (as pbrt-v4's "blackbody").
class BlackbodySpectrum final : public Spectrum {
 public:
  /// Throws InputError unless the temperature lies in [100, 1e6] K.
  explicit BlackbodySpectrum(double kelvin, const Location& where = {});
  float at(float lambda_nm) const override;
  Interval range_nm() const override { return kEveryWavelength; }
  float max_value() const override { return 1; }

 private:
  double kelvin_, scale_;
};

/// Product of another spectrum and a constant.
class ScaledSpectrum final : public Spectrum {
 public:
  ScaledSpectrum(SpectrumPtr base, double scale) : base_(std::move(base)), scale_(static_cast<float>(scale)) {}
  float at(float lambda_nm) const override { return scale_ * base_->at(lambda_nm); }
  SampledSpectrum sample(const SampledWavelengths& lambda) const override { return scale_ * base_->sample(lambda); }
  Interval range_nm() const override { return base_->range_nm(); }
  float max_value() const override { return scale_ * base_->max_value(); }
  const Spectrum& base() const { return *base_; }

 private:
  SpectrumPtr base_;
  float scale_;
};

/// Minimum of another spectrum and 1, such as a reflectance that must conserve energy.
class ClampedSpectrum final : public Spectrum {
 public:
  explicit ClampedSpectrum(SpectrumPtr base) : base_(std::move(base)) {}
  float at(float lambda_nm) const override { return std::min(1.f, base_->at(lambda_nm)); }
  Interval range_nm() const override { return base_->range_nm(); }
  float max_value() const override { return std::min(1.f, base_->max_value()); }

 private:
  SpectrumPtr base_;
};

}  // namespace frond

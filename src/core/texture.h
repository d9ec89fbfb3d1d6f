#pragma once

#include "core/params.h"
#include "core/plugin.h"
#include "core/spectrum.h"
#include "core/vec.h"

namespace frond {

/// A number over a surface's (u, v).
class FloatTexture {
 public:
  virtual ~FloatTexture() = default;
  virtual float evaluate(Vec2 uv) const = 0;
  /// Bounds of the values.
  virtual Interval range() const = 0;
  bool is_constant() const { return range().min == range().max; }
};

/// A reflectance or transmittance over a surface's (u, v), in [0, 1] at every wavelength.
class SpectrumTexture {
 public:
  virtual ~SpectrumTexture() = default;
  virtual SampledSpectrum evaluate(Vec2 uv, const SampledWavelengths& lambda) const = 0;
  /// Wavelengths (nm) for which the data stand.
  virtual Interval range_nm() const = 0;
  /// Upper bound of the values.
  virtual float max_value() const = 0;
};

/// Made from parameters that hold one number or spectrum, as materials use them.
class ConstantFloatTexture final : public FloatTexture {
 public:
  explicit ConstantFloatTexture(float value) : value_(value) {}
  float evaluate(Vec2) const override { return value_; }
  Interval range() const override { return {value_, value_}; }

 private:
  float value_;
};

class ConstantSpectrumTexture final : public SpectrumTexture {
 public:
  explicit ConstantSpectrumTexture(SpectrumPtr value) : value_(std::move(value)) {}
  SampledSpectrum evaluate(Vec2, const SampledWavelengths& lambda) const override { return value_->sample(lambda); }
  Interval range_nm() const override { return value_->range_nm(); }
  float max_value() const override { return value_->max_value(); }

 private:
  SpectrumPtr value_;
};

struct FloatTextureInfo : PluginInfo {
  std::unique_ptr<FloatTexture> (*make)(const Params&);
};
struct SpectrumTextureInfo : PluginInfo {
  std::unique_ptr<SpectrumTexture> (*make)(const Params&);
};

}  // namespace frond

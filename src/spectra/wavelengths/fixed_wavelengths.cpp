#include "spectra/wavelengths/fixed_wavelengths.h"

#include <bit>

namespace frond {
namespace {

/// Spectrum with its values at fixed wavelengths stored.
class PrecomputedSpectrum final : public Spectrum {
 public:
  PrecomputedSpectrum(SpectrumPtr spectrum, std::span<const float> nm) : spectrum_(std::move(spectrum)) {
    for (const float wavelength : nm) {
      const int lane = known_.count++;
      known_.nm[size_t(lane)] = wavelength;
      values_[lane] = spectrum_->at(wavelength);
    }
  }
  float at(float lambda_nm) const override { return spectrum_->at(lambda_nm); }
  Interval range_nm() const override { return spectrum_->range_nm(); }
  float max_value() const override { return spectrum_->max_value(); }
  SampledSpectrum sample(const SampledWavelengths& lambda) const override {
    const bool known = are_equal(std::bit_cast<Float4>(lambda.nm), std::bit_cast<Float4>(known_.nm));
    return known && lambda.count == known_.count ? values_ : spectrum_->sample(lambda);
  }
  const Spectrum& base() const { return *spectrum_; }

 private:
  SpectrumPtr spectrum_;
  SampledWavelengths known_;
  SampledSpectrum values_;
};

}  // namespace

SpectrumPtr precompute_at(SpectrumPtr spectrum, std::span<const float> nm) {
  if (nm.empty() || nm.size() > kLanes) return spectrum;
  return std::make_shared<PrecomputedSpectrum>(std::move(spectrum), nm);
}

const Spectrum* base_of_precomputed(const Spectrum& spectrum) {
  const auto* known = dynamic_cast<const PrecomputedSpectrum*>(&spectrum);
  return known ? &known->base() : nullptr;
}

}  // namespace frond

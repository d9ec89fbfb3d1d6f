#include "spectra/beyond_data.h"

#include "spectra/cie.h"

namespace frond {
namespace {

/// Extension of a spectrum to kCieRange_nm.
class BeyondData final : public Spectrum {
 public:
  BeyondData(SpectrumPtr base, Beyond beyond)
      : base_(std::move(base)),
        data_nm_(base_->range_nm()),
        range_nm_{std::min(data_nm_.min, kCieRange_nm.min), std::max(data_nm_.max, kCieRange_nm.max)},
        beyond_(beyond) {}
  float at(float lambda_nm) const override {
    const double nm = std::clamp(double(lambda_nm), range_nm_.min, range_nm_.max);
    return beyond_ == Beyond::held || data_nm_.contains(nm) ? base_->at(lambda_nm) : 0;
  }
  Interval range_nm() const override { return range_nm_; }
  float max_value() const override { return base_->max_value(); }

 private:
  SpectrumPtr base_;
  Interval data_nm_, range_nm_;
  Beyond beyond_;
};

}  // namespace

SpectrumPtr known_in_the_visible(SpectrumPtr s, Beyond beyond) {
  const Interval nm = s->range_nm();
  if (nm.min <= kCieRange_nm.min && nm.max >= kCieRange_nm.max) return s;
  return std::make_shared<BeyondData>(std::move(s), beyond);
}

}  // namespace frond

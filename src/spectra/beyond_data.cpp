#include "spectra/beyond_data.h"

#include <algorithm>

namespace frond {
namespace {

/// Extension of a spectrum.
class BeyondData final : public Spectrum {
 public:
  BeyondData(SpectrumPtr base, Beyond beyond, Interval to_nm)
      : base_(std::move(base)),
        data_nm_(base_->range_nm()),
        range_nm_{std::min(data_nm_.min, to_nm.min), std::max(data_nm_.max, to_nm.max)},
        beyond_(beyond) {}
  float at(float lambda_nm) const override {
    const double nm = std::clamp(double(lambda_nm), range_nm_.min, range_nm_.max);
    return beyond_ == Beyond::held || data_nm_.contains(nm) ? base_->at(lambda_nm) : 0;
  }
  Interval range_nm() const override { return range_nm_; }
  float max_value() const override { return base_->max_value(); }
  const Spectrum& base() const { return *base_; }

 private:
  SpectrumPtr base_;
  Interval data_nm_, range_nm_;
  Beyond beyond_;
};

}  // namespace

SpectrumPtr beyond_data(SpectrumPtr s, Beyond beyond, Interval range_nm) {
  const Interval nm = s->range_nm();
  if (nm.min <= range_nm.min && nm.max >= range_nm.max) return s;
  return std::make_shared<BeyondData>(std::move(s), beyond, range_nm);
}

const Spectrum* base_of_extended(const Spectrum& s) {
  const auto* extended = dynamic_cast<const BeyondData*>(&s);
  return extended ? &extended->base() : nullptr;
}

}  // namespace frond

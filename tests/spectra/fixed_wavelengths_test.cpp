#include "spectra/wavelengths/fixed_wavelengths.h"

#include <gmock/gmock.h>

#include "spectra/analytic.h"

namespace frond {
namespace {

SampledWavelengths lambda_of(std::initializer_list<float> nm) {
  SampledWavelengths lambda;
  for (const float wavelength : nm) lambda.nm[size_t(lambda.count++)] = wavelength;
  return lambda;
}

/// Looks nothing up where it should not.
class Counted final : public Spectrum {
 public:
  explicit Counted(int& calls) : calls_(calls) {}
  float at(float lambda_nm) const override { return ++calls_, lambda_nm / 1000; }
  Interval range_nm() const override { return kEveryWavelength; }
  float max_value() const override { return 1; }

 private:
  int& calls_;
};

TEST(FixedWavelengths, AreLookedUpOnce) {
  int calls = 0;
  const auto spectrum = std::make_shared<Counted>(calls);
  constexpr std::array kNm{608.f, 551.f, 455.f};
  const SpectrumPtr known = precompute_at(spectrum, kNm);
  EXPECT_EQ(calls, 3);
  EXPECT_EQ(known->sample(lambda_of({608, 551, 455})), spectrum->sample(lambda_of({608, 551, 455})));
  EXPECT_EQ(calls, 6);  // the spectrum's own
  EXPECT_EQ(known->sample(lambda_of({608, 551, 456})), spectrum->sample(lambda_of({608, 551, 456})));
  EXPECT_EQ(known->sample(lambda_of({608, 551})), spectrum->sample(lambda_of({608, 551})));
  EXPECT_EQ(known->at(700), 0.7f);
  EXPECT_EQ(precompute_at(spectrum, {}), spectrum);
}

}  // namespace
}  // namespace frond

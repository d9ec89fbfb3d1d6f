#pragma once

#include <array>
#include <string>

#include "materials/measured/goniometer_bsdf.h"
#include "materials/measured/goniometer_rows.h"

namespace frond {

/// BSDF measured with a goniometer; only the difference of the azimuths matters (docs/measured.md).
///
/// Directions lie on rings of equal theta. Within a ring f is linear in phi, between rings linear in theta. From the
/// first ring to the pole it changes to the ring's mean; beyond the last ring that ring is used. If all phi lie in [0,
/// 180], the other half is their mirror image. Means over patches that cover a hemisphere are scaled, one factor for
/// each incidence and wavelength, so that the integral equals the sum over the patches. A side that was not lit
/// scatters as the other one.
class GoniometerTable final : public MeasuredData {
 public:
  /// Throws InputError for two values of one direction, for wavelengths that are missing at an incidence, and for
  /// directions that do not form rings.
  explicit GoniometerTable(const std::vector<GoniometerRow>& rows);

  Interval range_nm() const override { return {double(nm_.front()), double(nm_.back())}; }
  void prepare(Interval range_nm) override;
  const Bsdf* bsdf(const SampledWavelengths& lambda, Arena& arena) const override;
  /// Values that were changed: below 0, or scaled because more light than arrives would leave.
  std::string warning() const override { return warning_; }

 private:
  void limit_energy();

  std::vector<float> nm_;
  std::array<GoniometerFace, 2> faces_;  ///< front, back
  std::string warning_;
};

}  // namespace frond

#pragma once

#include "materials/measured/direction_grid.h"
#include "materials/measured/measured_data.h"
#include "materials/measured/nodes.h"

namespace frond {

/// Table of one lit side of a sheet.
struct GoniometerFace {
  std::vector<float> incidence;  ///< radians from the lit side's normal, ascending
  /// A slice for each incidence. Polar angles are measured from the normal of the side that the light leaves on.
  DirectionGrid reflected, transmitted;
};

/// BSDF by tables: linear between incidence angles; beyond the first and last one these are used. The incident
/// direction is wo.
class GoniometerBsdf final : public Bsdf {
 public:
  /// `wavelengths_nm`: of the tables.
  GoniometerBsdf(const std::array<GoniometerFace, 2>& front_back, std::span<const float> wavelengths_nm,
                 const SampledWavelengths& lambda);

  Lobes flags() const override;
  SampledSpectrum f(const Vec3& wo, const Vec3& wi, RandomStream&) const override;
  std::optional<BsdfSample> sample(const Vec3& wo, float, Vec2 u, RandomStream& rng) const override;
  float pdf(const Vec3& wo, const Vec3& wi) const override;

 private:
  const GoniometerFace& lit_face(const Vec3& wo) const { return faces_[wo.z < 0 ? 1 : 0]; }
  const DirectionGrid& grid(const Vec3& wo, const Vec3& wi) const {
    return same_side(wo, wi) ? lit_face(wo).reflected : lit_face(wo).transmitted;
  }

  const std::array<GoniometerFace, 2>& faces_;
  std::array<leaf::AxisCell, kLanes> lanes_;
  SampledSpectrum mask_;
};

}  // namespace frond

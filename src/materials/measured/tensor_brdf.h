#pragma once

#include <array>
#include <vector>

#include "materials/measured/bilinear_density.h"
#include "materials/measured/measured_data.h"
#include "materials/measured/nodes.h"
#include "system/tensor_file.h"

namespace frond {

/// Measured BRDF in the adaptive parameterization of Dupuy and Jakob 2018: values are stored over the unit square that
/// the warps of two densities, `vndf` and `luminance`, map to half vectors. The densities depend on wo, which is the
/// incident direction of the measurement.
class TensorBrdf final : public MeasuredData {
 public:
  /// f (without the wavelength) and the density of `sample` for two directions above the surface.
  struct At {
    Vec2 u;          ///< where the spectra are stored
    float per_unit;  ///< f / spectrum
    float pdf;       ///< per solid angle of wi
  };
  /// Interpolation for a direction wo.
  struct Outgoing {
    float theta, phi;
    SliceMix mix;
  };

  /// Throws InputError for a file that lacks a field or has fields that do not fit each other.
  explicit TensorBrdf(const TensorFile& file);

  Interval range_nm() const override { return {double(nm_.front()), double(nm_.back())}; }
  bool is_isotropic() const override { return isotropic_; }
  const Bsdf* bsdf(const SampledWavelengths& lambda, Arena& arena) const override;

  Outgoing outgoing(const Vec3& wo) const;
  /// wo.z and wi.z are positive.
  At at(const Outgoing& out, const Vec3& wo, const Vec3& wi) const;
  /// Returns a direction, which may lie below the surface.
  Vec3 sample(const Outgoing& out, const Vec3& wo, Vec2 u) const;
  /// Spectral values at a point of the unit square.
  SampledSpectrum spectrum(const SliceMix& mix, Vec2 u, const std::array<leaf::AxisCell, kLanes>& cells) const;
  const std::vector<float>& nm() const { return nm_; }

 private:
  std::vector<float> phi_, theta_, nm_;
  bool isotropic_ = true;
  BilinearStack ndf_, sigma_, spectra_;
  BilinearDensity vndf_, luminance_;
};

}  // namespace frond

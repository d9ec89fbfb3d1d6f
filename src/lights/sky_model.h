#pragma once

#include <algorithm>
#include <vector>

#include "core/math/vec.h"
#include "core/params.h"
#include "lights/sky_shape.h"
#include "spectra/spectrl2.h"

namespace frond {

/// Data of the parameters: spectra, angular distribution and sun of a sky. z is up.
struct SkyModel {
  Vec3d toward_sun;   ///< unit, light space
  double sun_radius;  ///< angle, rad
  bool is_overcast;
  std::vector<double> nm, direct_normal, diffuse;  ///< W m^-2 nm^-1; all 0 unless the sun is above the horizon
  SkyShape shape{};

  explicit SkyModel(const Params& p);
  /// Factor on the radiance of a disc that the horizon cuts: what remains gives SPECTRL2's irradiance on a horizontal
  /// plane.
  double horizon_factor() const;
  double sun_zenith_deg() const;
  /// Irradiance of the sun on a horizontal plane, W m^-2.
  double direct_total() const { return integral(nm, direct_normal) * std::max(0.0, toward_sun.z); }
  double diffuse_total() const { return integral(nm, diffuse); }

 private:
  void scale_to_measured(const Params& p);
};

/// Returns the integrals over the upper hemisphere of a sky's shape: of its radiance times the cosine, and of its
/// radiance.
struct ShapeIntegrals {
  double irradiance = 0, sphere = 0;
  ShapeIntegrals(const SkyShape& shape, double sun_zenith_deg);
};

}  // namespace frond

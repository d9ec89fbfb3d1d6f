#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "core/spectrum.h"
#include "core/texture.h"
#include "leaf/tissue/tissue_params.h"

namespace frond::leaf {

/// Optical depth of the mesophyll of a leaf whose chemistry or thickness follows textures. Concentrations, thickness
/// and mesophyll fraction affect light through this one number.
class DepthMap {
 public:
  /// A parameter of TissueParams that a texture replaces.
  struct Varying {
    std::function<double&(TissueParams&)> number;
    std::shared_ptr<const FloatTexture> texture;
  };
  /// `constant` gives the parameters that are not in `varying`.
  DepthMap(const TissueParams& constant, const std::vector<Varying>& varying);

  /// Whether the depth is the same everywhere.
  bool is_constant() const { return curves_.empty() && !thickness_.texture && !fraction_.texture; }

  /// Returns the optical depth along the normal, for each lane in use.
  std::array<double, kLanes> at(const TexturePoint& point, const SampledWavelengths& lambda) const;
  /// Bounds of the depth over the leaf at a wavelength (nm).
  Interval range(double lambda_nm) const;

 private:
  /// A number that multiplies the absorption coefficient: constant or a texture.
  struct Factor {
    double constant;
    std::shared_ptr<const FloatTexture> texture;  ///< nullptr: constant
    double at(const TexturePoint& point) const { return texture ? double(texture->evaluate(point)) : constant; }
    Interval range() const { return texture ? texture->range() : Interval{constant, constant}; }
  };
  /// A concentration that varies, and the absorption of 1 kg/m^3 of it at kAbsorptionGrid.
  struct Curve {
    std::shared_ptr<const FloatTexture> concentration;
    std::vector<double> absorption;
  };

  Factor thickness_, fraction_;
  std::vector<double> base_;  ///< absorption of all that is constant, at kAbsorptionGrid
  std::vector<Curve> curves_;
};

}  // namespace frond::leaf

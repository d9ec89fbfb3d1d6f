#pragma once

#include <span>
#include <string>
#include <vector>

#include "spectra/tabulated.h"

namespace frond::leaf {

/// Emission of chlorophyll inside the tissue, before reabsorption: distribution of the wavelengths of photons from 640
/// to 850 nm (kEmission_nm).
class EmissionShape {
 public:
  /// Two Gaussians, near 688 and 746 nm, after Zarco-Tejada et al. 2002 (see emission.cpp).
  EmissionShape();
  /// A tabulated one, linear between the points and 0 beyond them; any unit, since it is normalised. `name`: in
  /// results. Throws InputError at `where` if it is 0 at every whole nanometre from 640 to 850.
  EmissionShape(std::string name, std::span<const SpectrumPoint> points, const Location& where);

  const std::string& name() const { return name_; }
  /// Returns the density, 1/nm, linear between whole nanometres; its sum over these is 1.
  double at(double lambda_nm) const;

 private:
  void normalize();

  std::string name_;
  std::vector<double> density_;  ///< at whole nanometres
};

/// Returns the share of the emission that remains at a wavelength near that of the excitation or shorter: 1/(1 + exp(
/// (excitation - emission) / 10 nm)), as in Fluspect (Vilfan et al. 2016, Remote Sensing of Environment 186:596-615).
double stokes_gate(double emission_nm, double excitation_nm);

/// Returns the number of photons emitted, per nm, for each photon that the fluorescing constituents absorb.
inline double emitted_density(double yield, const EmissionShape& shape, double emission_nm, double excitation_nm) {
  return yield * shape.at(emission_nm) * stokes_gate(emission_nm, excitation_nm);
}

}  // namespace frond::leaf

#pragma once

#include "leaf/walk/walk.h"

namespace frond::leaf {

/// Random walks of fluorescence: light walks at the wavelength of excitation until the mesophyll absorbs it; the
/// absorber emits isotropically where it has absorbed, and the emitted light walks on at the wavelength of emission,
/// refracted and reabsorbed as any light. Reabsorbed light does not excite again. Every absorption leads to an emitted
/// photon here: the share of the absorption that excites fluorescence (fluorescing_share), the yield and the spectrum
/// (emitted_density) are the caller's factors.

/// A leaf at the wavelengths of excitation and emission.
struct FluorescingTissue {
  const Tissue &excited, &emitting;
};

/// Where the light goes that one incident photon excites: numbers per incident photon, unbiased estimates. left[0],
/// left[1]: through the lit and the other side.
struct FluorescenceEnd {
  double emitted = 0, reabsorbed = 0, left[2] = {};
};

/// One walk; `wi` points to the light.
FluorescenceEnd walk_fluorescence(const FluorescingTissue& leaf, const Vec3d& wi, Absorption absorption,
                                  RandomStream& rng);

/// Returns an unbiased estimate, by one walk, of the radiance along `wo` over the irradiance by light from `wi`, in
/// photons, 1/sr.
double estimate_fluorescence_f(const FluorescingTissue& leaf, const Vec3d& wo, const Vec3d& wi, Absorption absorption,
                               RandomStream& rng);

}  // namespace frond::leaf

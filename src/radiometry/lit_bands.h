#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "radiometry/horizontal_irradiance.h"
#include "spectra/wavelengths/response_sampler.h"

namespace frond {

/// Returns the number of successive samples after which their bands repeat.
uint64_t turns_of(const WavelengthStrategy& strategy);

/// Light of a band with a response: integrals over the wavelength, weighted by the response.
struct BandLight {
  double energy = 0;   ///< irradiance; W/m^2 if the light's unit is W/(m^2 nm)
  double mean_nm = 0;  ///< mean wavelength of the energy: photons are proportional to energy times wavelength
};

/// Wavelengths of light paths. In a band with a response, the density is proportional to response times irradiance: the
/// mean of the shares that paths carry is then the share of the band's light (docs/radiometry.md), and each path has
/// the same weight. Otherwise the wavelengths are those of the scene's strategy.
class LitBands {
 public:
  /// `irradiance`: of any unit; nullptr: the irradiance of the scene. `strategy` must outlive this object. `ranges`:
  /// of the bands, in place of their responses; empty: the bands have their responses. Throws InputError for an
  /// irradiance that is unknown or 0 in a band, or larger than 0 at a wavelength at which the scene has no light.
  LitBands(const WavelengthStrategy& strategy, const HorizontalIrradiance& of_scene, const SpectrumPtr& irradiance,
           std::span<const Interval> ranges = {});

  /// Returns the incident light of a band with a response, of all lights and of the direct light alone (is_direct).
  BandLight light(size_t band) const { return {samplers_[band].integral(), samplers_[band].centroid_nm()}; }
  const BandLight& direct_light(size_t band) const { return direct_[band]; }

  /// As WavelengthStrategy::sample_for_index.
  SampledWavelengths sample_for_index(uint64_t index, float u) const {
    SampledWavelengths lambda = strategy_.sample_for_index(index, u);
    if (!samplers_.empty())
      for (size_t lane = 0; lane < size_t(lambda.count); ++lane)
        lambda.nm[lane] = samplers_[lambda.band[lane]].sample(u);
    return lambda;
  }

 private:
  const WavelengthStrategy& strategy_;
  std::vector<ResponseSampler> samplers_;  ///< by band; empty if the bands are single wavelengths
  std::vector<BandLight> direct_;          ///< by band, as samplers_
};

/// Throws InputError unless the data of an irradiance cover `needed_nm`, or end with 0: there is no light beyond.
/// `what` needs them, as in "band nir needs".
void check_covers(const Spectrum& irradiance, Interval needed_nm, std::string_view what);

}  // namespace frond

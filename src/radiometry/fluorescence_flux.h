#pragma once

#include <memory>
#include <string>
#include <vector>

#include "radiometry/brf.h"

namespace frond {

/// Request of the photons of fluorescence in a scene.
struct FluorescenceFluxRequest {
  std::optional<Target> target = {};                 ///< as in BrfRequest
  std::optional<std::array<double, 2>> period = {};  ///< replaces the scene's period
  std::vector<double> emission_nm;                   ///< within kEmission_nm
  bool by_instance = false;                          ///< also measure each instance
};

/// Numbers of photons per photon that enters through the target from 400 to 750 nm. Those of fluorescence are
/// densities, 1/nm, by wavelength of emission. What happens inside is unknown, NaN, if a leaf has only matrices.
struct FluorescenceFluxMeasurement {
  struct OfMaterial {
    std::string name;
    std::vector<MeanError> absorbed;  ///< fluorescence that has left a surface and is absorbed by one of this material
  };
  struct OfInstance {
    MeanError excited;
    std::vector<MeanError> emitted, left;
  };
  std::vector<double> emission_nm;
  std::vector<std::string> shapes;          ///< distributions of the emitted wavelengths, each once
  double incident = 0;                      ///< umol m^-2 s^-1 where lights are in W m^-2 nm^-1: 400 to 750 nm
  MeanError excited;                        ///< absorbed by the constituents that emit
  std::vector<MeanError> emitted;           ///< inside surfaces
  std::vector<MeanError> reabsorbed;        ///< of the emitted ones, by the surface itself
  std::vector<MeanError> left;              ///< of the emitted ones, leave the surface on either side
  std::vector<MeanError> upward, downward;  ///< of those, leave the scene
  std::vector<MeanError> escape;            ///< upward / left
  std::vector<OfMaterial> materials;        ///< of surfaces
  std::vector<OfInstance> instances = {};   ///< empty unless requested
  uint64_t paths = 0;
  /// Returns the RMS over wavelengths of the standard errors of `upward`, relative to the means.
  double relative_error() const;
};

/// Traces light from 400 to 750 nm from a scene's sun and sky through a horizontal rectangle, and the fluorescence that
/// it excites, until it is absorbed or leaves. Light that fluorescence has excited excites no more.
class FluorescenceFluxMeter {
 public:
  /// Throws InputError. `other`: a scene with the same geometry, which is then shared.
  FluorescenceFluxMeter(Session& session, SceneDescription description, const FluorescenceFluxRequest& request,
                        const Scene* other = nullptr);
  ~FluorescenceFluxMeter();

  /// Traces this many further paths, rounded up to an even number, or fewer if stopped or out of time. The result
  /// depends only on the total number.
  void trace(uint64_t paths, ThreadPool& pool, const RenderControl& control = {});
  FluorescenceFluxMeasurement read() const;
  uint64_t paths() const;  ///< number of paths traced
  const LoadedScene& loaded() const;
  const Target& target() const;

 private:
  class Block;
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace frond

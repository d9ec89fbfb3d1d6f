#pragma once

#include <array>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include "radiometry/brf.h"
#include "radiometry/energy_budget.h"
#include "radiometry/organs.h"
#include "radiometry/sums_file.h"

namespace frond {

/// Request of the light budget of a scene.
struct FluxRequest {
  std::optional<Target> target = {};                 ///< as in BrfRequest
  std::optional<std::array<double, 2>> period = {};  ///< replaces the scene's period
  std::string wavelengths = {};                      ///< a PluginText of `bands`
  /// Spectral irradiance, of any unit, by which bands with responses are weighted; nullptr: that of the scene's lights.
  SpectrumPtr irradiance = {};
  std::string irradiance_name = {};  ///< identifies `irradiance`
  /// Light also enters through the sides of the box between the target and the scene's bottom. Shares may exceed 1:
  /// they remain relative to the light through the target. For scenes that are not periodic.
  bool sides = false;
  std::optional<OrganKind> organs = {};  ///< also measure the absorption of each organ
  /// Also measure energy and photons, direct and diffuse light, and sunlit and shaded leaves, each apart:
  /// FluxMeasurement::energy. All bands must have responses.
  bool energy = false;
  /// With `energy`: ranges of the bands. The optics of surfaces are taken at the nearest wavelength of the responses of
  /// `wavelengths`, which may be narrower. Empty: those responses.
  std::vector<Interval> ranges_nm = {};
  std::vector<std::string> leaves = {};  ///< with `energy`: materials that count as leaves; empty: all leaf models
};

/// Light budget by band: shares of the light that enters through the target.
struct FluxMeasurement {
  struct OfMaterial {
    std::string name;
    std::vector<MeanError> absorbed;    ///< by its surfaces
    std::vector<MeanError> incident;    ///< light on either side; repeated incidence counts each time
    std::vector<MeanError> uncollided;  ///< the share of `incident` without an earlier interaction
    bool is_hit = true;                 ///< by any path; else the shares are 0 with an unknown error, NaN
    double area = 0;  ///< one-sided, in scene units squared; NaN if surfaces of it are parts of instances
  };
  std::vector<Band> bands;
  std::vector<MeanError> reflected;    ///< leaves upward
  std::vector<MeanError> transmitted;  ///< leaves downward, if there is no ground below
  std::vector<OfMaterial> materials;   ///< materials of surfaces
  std::vector<MeanError> sum;          ///< sum of all absorbed and leaving light: 1 up to noise
  uint64_t paths = 0;
  double target_area = 0;  ///< in scene units squared; 1 with lamps: shares are then of a power
  bool has_lamps = false;  ///< there are lamps in the scene
  /// Absorbed by each organ, by band; empty unless requested. The error is NaN where no path was absorbed.
  std::vector<MeanError> by_organ;
  std::vector<float> areas;  ///< one-sided area of each organ; empty unless requested
  std::optional<EnergyBudget> energy = {};
  /// Returns the RMS of the standard errors of reflected and absorbed shares, relative to the incident light.
  double error() const;
};

/// Traces light from a scene's sun and sky through a horizontal rectangle, and light of the lamps in the scene, until
/// it is absorbed or leaves. With lamps, the incident light is the power of both. BSDFs are evaluated for the actual
/// direction of the light, regardless of the scene's incident direction: energy is conserved.
class FluxMeter {
 public:
  /// Throws InputError, also if there are too many organs to measure each. `other`: a scene with the same geometry,
  /// which is then shared.
  FluxMeter(Session& session, SceneDescription description, const FluxRequest& request, const Scene* other = nullptr);
  ~FluxMeter();

  /// Traces this many further paths, one more if it is odd, or fewer if stopped or out of time. The result depends only
  /// on the total number.
  /// `after_round` is called periodically when the state can be saved; may be empty.
  void trace(uint64_t paths, ThreadPool& pool, const RenderControl& control = {},
             const std::function<void()>& after_round = {});
  /// Returns the measurement so far.
  FluxMeasurement read() const;
  /// Returns the organs; nullptr unless requested.
  const Organs* organs() const;
  /// Returns the area of the target, in scene units squared.
  double target_area() const;
  /// Returns the sunlit share of the area of each organ, from one point for each path so far; NaN without a sun.
  std::vector<MeanError> sunlit_organs(ThreadPool& pool) const;
  uint64_t paths() const;  ///< number of paths traced
  /// Begins with this path, a multiple of kBlockPaths, in a measurement without paths.
  void start_at(uint64_t path);
  uint64_t end() const;  ///< number of the last path, plus one
  /// Returns the sums of the paths so far.
  SumsPart part() const;
  /// Adds a part whose paths follow those so far. The result equals that of one measurement, to the last bit, if the
  /// part begins at a multiple of kBlockPaths. Throws InputError for a part of another measurement; `name`: of its
  /// file.
  void add(const SumsPart& part, const std::string& name);
  static constexpr uint64_t kBlockPaths = 1024;  ///< number of paths that are summed one by one
  const Scene& scene() const;

 private:
  EnergyBudget read_energy() const;

  class Block;
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace frond

#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include "radiometry/brf.h"

namespace frond {

/// What is asked of the light that falls on a scene.
struct FluxRequest {
  std::optional<Target> target = {};                 ///< that light falls through; as of a BrfRequest
  std::optional<std::array<double, 2>> period = {};  ///< in place of the scene's own
  std::string wavelengths = {};                      ///< a PluginText of `bands`
  bool by_instance = false;                          ///< what each instance of an object absorbs, too
  bool keeps_depth = false;                          ///< as of a BrfRequest
};

/// Where the light goes, band by band: shares of the light that falls through the target.
struct FluxMeasurement {
  struct OfMaterial {
    std::string name;
    std::vector<MeanError> absorbed;    ///< by its surfaces
    std::vector<MeanError> incident;    ///< that falls on them, on either side, every time that it does
    std::vector<MeanError> uncollided;  ///< of this what has met nothing before
  };
  std::vector<double> wavelengths_nm;
  std::vector<MeanError> reflected;    ///< leaves upward
  std::vector<MeanError> transmitted;  ///< leaves downward, where no ground is in its way
  std::vector<OfMaterial> materials;   ///< those that light fell on
  std::vector<MeanError> sum;          ///< of all that is absorbed or leaves: 1 but for its noise
  uint64_t paths = 0;
  double target_area = 0;              ///< in the scene's unit of length, squared
  std::vector<MeanError> by_instance;  ///< absorbed by each instance, band by band, where it was asked for
  std::vector<float> areas;            ///< of each instance, of one of its sides, where that was asked for
  /// Root mean square of the standard errors of what is reflected and absorbed, relative to the light that falls in.
  double error() const;
};

/// Sends light from a scene's sun and sky through a horizontal rectangle, and follows it as it is scattered and
/// absorbed. The BSDFs are asked what becomes of light that comes from where it does come from, whatever an image
/// calls incident: no energy is lost or made.
class FluxMeter {
 public:
  /// Throws InputError, also where instances are too many to count them one by one.
  FluxMeter(Session& session, SceneDescription description, const FluxRequest& request);
  ~FluxMeter();

  /// Follows so many paths more, or fewer where it is stopped or the time is over. The figures depend on their number
  /// alone.
  /// `after_round` is called from time to time, when what has been followed can be saved; may be empty.
  void trace(uint64_t paths, ThreadPool& pool, const RenderControl& control = {},
             const std::function<void()>& after_round = {});
  FluxMeasurement read() const;
  uint64_t paths() const;  ///< that have been followed
  /// Writes what there is, whole or not at all. Throws InputError with the system's reason.
  void save(const std::filesystem::path& path) const;
  /// Goes on from what `save` has written: the figures are those of a meter that has never been stopped. Throws
  /// InputError for a file of another measurement, or one that is cut short or damaged.
  void resume(const std::filesystem::path& path);
  const Scene& scene() const;

 private:
  class Sums;
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace frond

#pragma once

#include <array>
#include <vector>

#include "instruments/errors/statistics.h"
#include "render/session.h"

namespace frond {

/// A direction that a scene is seen from.
struct ViewDirection {
  double zenith_deg;   ///< 0: from above; a negative one lies on the other side of the zenith
  double azimuth_deg;  ///< of the plane that it lies in (BrfRequest::azimuth_of)
};

/// The horizontal rectangle of a scene that a sensor sees.
struct Target {
  double x0, x1, y0, y1, z;
};

/// What is asked of a bidirectional reflectance factor.
struct BrfRequest {
  std::vector<ViewDirection> views;
  std::optional<Target> target = {};                 ///< empty: one period, or the scene's bounds, at its top
  std::optional<std::array<double, 2>> period = {};  ///< in place of the scene's own
  std::string wavelengths = {};                      ///< a PluginText of `bands`
  bool keeps_depth = false;  ///< paths are as long as the description's integrator has them; else of any length
};

/// A scene's BRF, as far as it is known: the radiance toward a direction over that of a white Lambertian plane in the
/// same light.
struct BrfMeasurement {
  std::vector<ViewDirection> views;
  std::vector<double> wavelengths_nm;
  std::vector<MeanError> values;  ///< view by view, band by band
  std::vector<double> rows;       ///< of each of the values: its BrfMeter::kRows independent ones
  uint64_t paths = 0;             ///< for each view
  /// Standard errors are not to be trusted: a few paths that are hardly ever drawn carry much of the mean.
  bool has_heavy_tails = false;
  const MeanError& at(size_t view, size_t band) const { return values[view * wavelengths_nm.size() + band]; }
  /// Root mean square of the standard errors over views and bands, each relative to its mean.
  double relative_error() const;
};

/// Renders a scene as a distant radiometer sees it. A film has a column for each view, and kRows rows that are
/// independent of each other: how they differ tells the error, and knows how well a row's samples are spread.
class BrfMeter {
 public:
  static constexpr int kRows = 32;

  /// Throws InputError. Leaves are reciprocal, or take the light's direction for incident, where the scene does not
  /// say which, as energy asks for.
  /// `other`: a scene in which the same stands, which is then not made again.
  BrfMeter(Session& session, SceneDescription description, const BrfRequest& request, const Scene* other = nullptr);

  const LoadedScene& scene() const { return scene_; }
  BrfMeasurement read(const Film& film) const;

 private:
  BrfRequest request_;
  LoadedScene scene_ = {};
  std::vector<double> white_;  ///< radiance of a white plane, band by band
  bool has_heavy_tails_ = false;
};

}  // namespace frond

#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/wavelengths.h"
#include "instruments/errors/statistics.h"
#include "render/session.h"

namespace frond {

/// A direction from which a scene is seen.
struct ViewDirection {
  double zenith_deg;   ///< 0: nadir view from above; negative angles are on the opposite side of the zenith
  double azimuth_deg;  ///< azimuth of the view's plane
};

/// The horizontal rectangle that a sensor sees, in scene units.
struct Target {
  double x0, x1, y0, y1, z;
};

/// Request of a bidirectional reflectance factor.
struct BrfRequest {
  std::vector<ViewDirection> views;
  std::optional<Target> target = {};                 ///< empty: one period, or the scene's bounds, at its top
  std::optional<std::array<double, 2>> period = {};  ///< replaces the scene's period
  std::string wavelengths = {};                      ///< a PluginText of `bands`
  bool keeps_depth = false;  ///< true: path lengths are limited as in the scene; false: unlimited
  /// True: radiance of the bands of fluorescence, which are then the only ones, instead of a reflectance factor.
  bool fluorescence = false;
};

/// Reflectance factor of a scene: radiance in a direction over the radiance of a white Lambertian plane in the same
/// light. Terms: Schaepman-Strub et al. 2006, Remote Sensing of Environment 103:27-42.
struct BrfMeasurement {
  std::vector<ViewDirection> views;
  std::vector<Band> bands;
  std::vector<MeanError> values;  ///< by view, then band: reflectance factor, or radiance of fluorescence
  std::vector<double> rows;       ///< for each value, BrfMeter::kRows independent estimates; may be empty
  uint64_t paths = 0;             ///< for each view
  /// Name of the quantity: "BRF" (bidirectional) if all light comes from one direction, else "HDRF"
  /// (hemispherical-directional), as under sun and sky.
  std::string_view quantity = "BRF";
  std::optional<double> sun_zenith_deg = {};  ///< of the only sun, whose azimuth is 0; views at -zenith look from it
  /// True if standard errors are unreliable, because a few rare paths contribute much of the mean.
  bool has_heavy_tails = false;
  const MeanError& at(size_t view, size_t band) const { return values[view * bands.size() + band]; }
  /// Returns the RMS over views and bands of the standard errors relative to their means.
  double relative_error() const;
};

/// Returns the standard error of a mean over BrfMeter::kRows rows, from the differences of the two rows of each cell.
double error_of_rows(std::span<const double> rows);

/// Renders a scene as a distant radiometer sees it. The film has a column for each view and kRows independent rows. The
/// target is divided into kCells cells, and two adjacent rows see each: their differences estimate the error, including
/// the stratification over the target and within a row.
class BrfMeter {
 public:
  static constexpr int kRows = 128, kCells = kRows / 2;

  /// Throws InputError. Leaves without a stated incident direction become reciprocal, or take the light's direction as
  /// incident, so that energy is conserved.
  /// `other`: a scene with the same geometry, which is then shared.
  BrfMeter(Session& session, SceneDescription description, const BrfRequest& request, const Scene* other = nullptr);

  const LoadedScene& scene() const { return scene_; }
  /// Returns the measurement from a film of the scene. Only a comparison needs `rows`: 1 KiB for each value.
  BrfMeasurement read(const Film& film, bool with_rows = true) const;

 private:
  BrfRequest request_;
  LoadedScene scene_ = {};
  std::vector<double> white_;  ///< radiance of a white plane, band by band; of fluorescence 1
  bool has_heavy_tails_ = false;
  bool is_hemispherical_ = false;  ///< light comes from more than one direction
  std::optional<double> sun_zenith_deg_;
};

}  // namespace frond

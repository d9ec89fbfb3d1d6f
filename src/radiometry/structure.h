#pragma once

#include <memory>

#include "radiometry/brf.h"

namespace frond {

/// Request of the structure of a scene: its leaf area, and where rays pass it.
struct StructureRequest {
  std::vector<double> zeniths_deg;          ///< of the gap fraction, 0 to below 90
  std::vector<double> azimuths_deg = {};    ///< from +x toward +y; empty: the mean over all azimuths
  std::vector<std::string> materials = {};  ///< whose surfaces count as leaves, by name; empty: all leaf models
  std::optional<std::array<double, 2>> sun_deg = {};  ///< zenith and azimuth; empty: the scene's only sun
  std::optional<Target> target = {};                  ///< as in BrfRequest
  std::optional<std::array<double, 2>> period = {};   ///< replaces the scene's period
};

/// Structure of a scene. Leaf area is one-sided. An unknown value or error is NaN.
struct StructureMeasurement {
  /// Quantities of one zenith angle, and of one azimuth unless that is NaN: the mean over all azimuths.
  struct Direction {
    double zenith_deg, azimuth_deg;
    MeanError gap;         ///< gap fraction: share of the rays through the target that meet no leaf
    MeanError projection;  ///< G: mean of |cos| between leaf normals and the direction
    MeanError clumping;    ///< -ln(gap) cos(zenith) / (G * leaf area index); 1 for leaves at random
    MeanError sunlit;      ///< share of the leaf area that light from this direction reaches
  };
  static constexpr int kClasses = 18;  ///< of the inclination, 5 degrees each

  std::vector<Direction> directions;
  MeanError leaf_area_index = {};      ///< leaf area of the target's column over the target's area
  MeanError effective_index = {};      ///< from the gap fractions alone; NaN for fewer than three zenith angles
  MeanError mean_angle_deg = {};       ///< mean inclination of leaves
  std::vector<MeanError> angles = {};  ///< share of the leaf area by class of inclination
  MeanError sunlit = {};               ///< share of the leaf area that the sun reaches; NaN without a sun
  std::optional<std::array<double, 2>> sun_deg = {};  ///< zenith and azimuth of the sun
  double target_area = 0;
  uint64_t rays = 0;  ///< for each direction, and points of leaves
  /// Returns the RMS of the known standard errors of gap and sunlit fractions.
  double error() const;
};

/// Traces rays through a horizontal rectangle, from above, and from points of the leaves toward the light. Surfaces
/// that do not count as leaves do not stop the former; all surfaces cast shadows.
class StructureMeter {
 public:
  /// Throws InputError. No material is prepared: only shapes, their alpha and the sun have an effect.
  StructureMeter(Session& session, SceneDescription description, const StructureRequest& request);
  ~StructureMeter();

  /// Traces this many further rays for each direction, and as many points of leaves, or fewer if stopped or out of
  /// time. The result depends only on the total number.
  void trace(uint64_t rays, ThreadPool& pool, const RenderControl& control = {});
  /// Returns the measurement so far.
  StructureMeasurement read() const;
  uint64_t rays() const;
  const LoadedScene& scene() const;

 private:
  struct State;
  class Sums;
  std::unique_ptr<State> state_;
};

}  // namespace frond

#pragma once

#include <chrono>
#include <span>

#include "instruments/rays.h"
#include "jobs/record/common_params.h"
#include "render/measured_material.h"

/// Parameters, materials under test and progress, shared by the jobs of both instruments.
namespace frond {

inline constexpr JobParam kAnglesParam("angles", ArgumentKind::numbers,
                                       "Angles of incidence from the front's normal; above 90 the back is lit.",
                                       {.default_value = "8",
                                        .unit = "degrees",
                                        .range = {0, 180},
                                        .aliases = "angle",
                                        .decides = true,
                                        .quantity = Quantity::angle});
inline constexpr JobParam kInstrumentWavelengthsParam(
    "wavelengths", ArgumentKind::numbers, "Wavelengths, as in 450,550,670 or 400:700:10.",
    {.unit = "nm", .range = {360, 2500}, .aliases = "wavelength", .decides = true, .required = true});
inline constexpr JobParam kRenderedParam("rendered", ArgumentKind::flag,
                                         "Measure what an image shows: light arrives along wi and the detector is at "
                                         "wo, also for models whose incident direction is wo.",
                                         {.decides = true});
inline constexpr Interval kRayCounts{2, kCounts.max};

/// The materials under test and the beams on them. They are created and checked before the first ray.
class MaterialsUnderTest {
 public:
  /// Throws InputError for a material that does not exist, or that has a delta lobe with --rendered.
  explicit MaterialsUnderTest(const JobRun& run);

  const std::vector<double>& angles_deg() const { return angles_deg_; }
  const std::vector<double>& wavelengths_nm() const { return wavelengths_nm_; }
  const std::vector<MeasuredMaterial>& materials() const { return materials_; }
  /// Number of measurements. Wavelengths vary fastest, then angles, then materials.
  size_t size() const { return materials_.size() * per_material(); }
  size_t per_material() const { return angles_deg_.size() * wavelengths_nm_.size(); }

  /// Returns material and beam of measurement i. Its random numbers depend on material, angle and wavelength, not on i.
  LitMaterial lit_material(size_t i) const;
  const MeasuredMaterial& material(size_t i) const { return materials_[i / per_material()]; }

  /// Returns the progress callback for `shoot` in measurement i. It throws Stopped if the front end has requested a
  /// stop.
  RayProgress progress(size_t i, int64_t rays_each) const;
  /// Returns comment lines of the CSV file: instrument, materials, and which direction is the incident one.
  std::vector<std::string> notes(std::string_view instrument) const;

 private:
  const JobRun& run_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  bool as_rendered_;
  std::vector<double> angles_deg_, wavelengths_nm_;
  std::vector<MeasuredMaterial> materials_;
};

}  // namespace frond

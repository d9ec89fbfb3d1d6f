#pragma once

#include <chrono>
#include <span>

#include "instruments/rays.h"
#include "jobs/record/common_params.h"
#include "render/measured_material.h"
#include "report/table.h"

/// Parameters, materials under test and progress, shared by the jobs of both instruments.
namespace frond {

inline constexpr JobParam kAnglesParam("angles", ArgumentKind::numbers,
                                       "Angles of incidence from the front's normal; above 90 the back is lit.",
                                       {.default_value = "8",
                                        .unit = "degrees",
                                        .range = {0, 180},
                                        .aliases = "angle",
                                        .decides = true,
                                        .quantity = PhysicalQuantity::angle});
inline constexpr JobParam kInstrumentWavelengthsParam(
    "wavelengths", ArgumentKind::text,
    "Wavelengths, as in 450,550,670 or 400:700:10, from 360 to 2500; or bands,responses=...",
    {.type = "WAVELENGTHS", .unit = "nm", .aliases = "wavelength", .decides = true, .required = true});
/// The same for instruments with --fluorescence, which has wavelengths of excitation and emission instead.
inline constexpr JobParam kOptionalWavelengthsParam = [] {
  JobParam param = kInstrumentWavelengthsParam;
  param.required = false;
  return param;
}();
/// Throws InputError unless that parameter is given.
void check_wavelengths_are_given(const JobRun& run);
inline constexpr JobParam kIlluminantParam(
    "illuminant", ArgumentKind::text,
    "Spectrum of the light, of any unit, by which bands with responses are weighted: name of a spectrum, or a "
    "spectrum file. By default that of equal energy.",
    {.type = "SPECTRUM", .default_value = "stdillum-E", .decides = true});
inline constexpr JobParam kRenderedParam("rendered", ArgumentKind::flag,
                                         "Measure what an image shows: light arrives along wi and the detector is at "
                                         "wo, also for models whose incident direction is wo.",
                                         {.decides = true});
inline constexpr Interval kRayCounts{2, kCounts.max};

/// Appends what identifies a beam's light in a row of data: the name of a band, and the wavelength.
void add_light(Table& table, const Beam& beam);

/// The materials under test and the beams on them. They are created and checked before the first ray.
class MaterialsUnderTest {
 public:
  /// Throws InputError for a material that does not exist, or that has a delta lobe with --rendered.
  explicit MaterialsUnderTest(const JobRun& run);

  const std::vector<double>& angles_deg() const { return angles_deg_; }
  /// The lights: single wavelengths, or bands.
  const std::vector<Beam>& lights() const { return lights_; }
  const std::vector<MeasuredMaterial>& materials() const { return materials_; }
  /// Number of measurements. Wavelengths vary fastest, then angles, then materials.
  size_t size() const { return materials_.size() * per_material(); }
  size_t per_material() const { return angles_deg_.size() * lights_.size(); }

  /// Returns material and beam of measurement i. Its random numbers depend on material, angle and wavelength, not on i.
  LitMaterial lit_material(size_t i) const;
  const MeasuredMaterial& material(size_t i) const { return materials_[i / per_material()]; }

  /// Returns the progress callback for `tally_rays` in measurement i. It throws Stopped if the front end has requested
  /// a stop.
  RayProgress progress(size_t i, int64_t rays_each) const;
  /// Returns the sentence that names the illuminant of bands; empty for single wavelengths.
  std::string illuminant_line() const;
  /// Returns the same as a line of text.
  std::string illuminant_text() const { return bands_.empty() ? "" : illuminant_line() + '\n'; }
  /// Returns comment lines of the CSV file: instrument, materials, and which direction is the incident one.
  std::vector<std::string> notes(std::string_view instrument) const;

 private:
  void read_wavelengths();
  InstrumentBand lit_band(const Band& band) const;

  const JobRun& run_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  bool as_rendered_;
  std::vector<double> angles_deg_;
  std::vector<InstrumentBand> bands_;
  std::vector<Beam> lights_;  ///< at no angle
  std::vector<MeasuredMaterial> materials_;
};

}  // namespace frond

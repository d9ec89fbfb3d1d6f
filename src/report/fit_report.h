#pragma once

#include <string>

#include "leaf/fit/fit.h"
#include "report/chart.h"

namespace frond {

/// A leaf that was fitted to measurements, as people and programs read it.
struct FitReport {
  const leaf::FitRequest& request;
  const leaf::FitResult& result;
  std::string source;    ///< the file with the measurements
  std::string material;  ///< that the leaf is written down for
};

/// A `Material` line of a scene file, with comments that say where it comes from and what is not told by the data.
std::string fit_scene(const FitReport& report);
/// Errors by band, the numbers with their errors, which of them go together, and what is not told.
std::string fit_text(const FitReport& report);
/// All of it, and the spectra.
std::string fit_json(const FitReport& report);
/// Measured and fitted, wavelength by wavelength.
std::string fit_csv(const FitReport& report);
/// R from below, T from above, measured as points, fitted as lines.
Chart fit_chart(const FitReport& report);

}  // namespace frond

#pragma once

#include "report/chart.h"
#include "report/patch_tables.h"

namespace frond {

/// Numbers of materials, angles and wavelengths of a set of measurements, for the limits of charts.
struct MeasurementCounts {
  size_t materials, angles, wavelengths;
};

/// Returns a chart of f in the plane of incidence, as in Figures 1 and 4 of Baranoski and Rokne: BRDF above, BTDF
/// below; a column for each angle of incidence, a colour for each wavelength, a dash for each material; bars of one
/// standard error. If a material's f was integrated, only its curve is a line, and measured values are points.
Chart plane_chart(const std::vector<LabelledPatches>& measurements);
/// Throws InputError if the chart has too many curves, or if no patch is centred in the plane of incidence opposite the
/// light.
void check_plane_chart(const MeasurementCounts& counts, const DetectorSphere& sphere);

/// Returns polar maps of f over both hemispheres, one row for each measurement, BRDF left and BTDF right, on one colour
/// scale. Both are seen from the light's side, with the light from the left. Marks show the light's direction and the
/// mirror or the straight direction.
Chart map_chart(const std::vector<LabelledPatches>& measurements, bool logarithmic);
/// Throws InputError for more maps than a chart can hold.
void check_map_chart(const MeasurementCounts& counts, const DetectorSphere& sphere);

}  // namespace frond

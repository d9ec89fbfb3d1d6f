#pragma once

#include "report/chart.h"
#include "report/patch_tables.h"

namespace frond {

/// What a set of measurements spans, for the limits of charts.
struct MeasurementCounts {
  size_t materials, angles, wavelengths;
};

/// f in the plane of incidence, as in Figures 1 and 4 of Baranoski and Rokne: BRDF above, BTDF below, a column for each
/// angle of incidence, a colour for each wavelength, a dash for each material; bars of one standard error. Where f of a
/// material was integrated, its curve alone is a line, and measured ones are points about it.
Chart plane_chart(const std::vector<LabelledPatches>& measurements);
/// Throws InputError where that chart cannot be read, or where no patch is centred across from the light.
void check_plane_chart(const MeasurementCounts& counts, const DetectorSphere& sphere);

/// f over both hemispheres, a row for each measurement, BRDF left and BTDF right, on one colour scale. Both are seen
/// from the light's side, the light coming from the left; its direction and the mirror direction or the straight one
/// are marked.
Chart map_chart(const std::vector<LabelledPatches>& measurements, bool logarithmic);
void check_map_chart(const MeasurementCounts& counts, const DetectorSphere& sphere);

}  // namespace frond

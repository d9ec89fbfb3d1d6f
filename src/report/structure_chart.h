#pragma once

#include "radiometry/structure.h"
#include "report/chart.h"

namespace frond {

/// Returns a chart against the zenith angle: the gap fraction, with that of leaves at random, and G, the clumping index
/// and the sunlit fraction, with standard errors; one series for each azimuth.
Chart structure_chart(const StructureMeasurement&);

}  // namespace frond

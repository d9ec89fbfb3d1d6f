#pragma once

#include <string_view>

#include "leaf/tissue/tissue_params.h"

namespace frond::leaf {

/// Mass of a constituent per leaf area, kg/m^2: its concentration in the mesophyll (kg/m^3) x thickness x mesophyll
/// fraction. The only definition of the conversion.
inline double area_content(const TissueParams& p, double concentration) {
  return concentration * p.thickness_m * p.mesophyll_fraction;
}

/// Concentration of water in the mesophyll, kg/m^3: the model's mesophyll absorbs like pure water.
inline constexpr double kWaterConcentration = 1000;

/// A unit of contents per leaf area.
struct AreaUnit {
  std::string_view name;
  double per_kg_per_m2;  ///< this many of the unit are 1 kg/m^2
};
inline constexpr AreaUnit kMicrogramsPerCm2{"ug/cm2", 1e5}, kMilligramsPerCm2{"mg/cm2", 100},
    kGramsPerCm2{"g/cm2", 0.1}, kProspectUnits{"", 1};  ///< the last: of brown pigments

}  // namespace frond::leaf

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
  std::string_view name, column;  ///< in reports, and at the end of a column's name
  double per_kg_per_m2 = 0;       ///< this many of the unit are 1 kg/m^2; 0: no unit
  double typical = 0;             ///< a content of a leaf, for messages
};
inline constexpr AreaUnit kMicrogramsPerCm2{"ug/cm2", "_ug_cm2", 1e5, 40}, kMilligramsPerCm2{"mg/cm2", "_mg_cm2", 100},
    kGramsPerCm2{"g/cm2", "_g_cm2", 0.1, 0.012}, kProspectUnits{"", "_content", 1};  ///< the last: of brown pigments

/// Content of a leaf per area: one constituent, or several together.
struct AreaContent {
  std::string_view name;  ///< in reports; empty: none
  AreaUnit unit;          ///< that the literature uses
  std::string_view prospect_symbol;
  bool is_in_all = false;  ///< leaves without it are not described by PROSPECT's parameters
  double kg_per_m3 = 1;    ///< mass in the mesophyll of one unit of the number
};

}  // namespace frond::leaf

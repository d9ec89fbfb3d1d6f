#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/spectrum.h"
#include "instruments/errors/statistics.h"
#include "radiometry/leaf_points.h"

namespace frond {

/// A quantity of the light budget in one band, apart by where the light came from (is_direct), as shares of all
/// incident light of the band: direct and diffuse add up to the total.
struct LightParts {
  MeanError total, direct, diffuse;
};

/// Shares of the incident energy, and of the incident photons.
struct EnergyShare {
  LightParts energy, photons;
};

/// Incident light of a band on a horizontal plane, or light of lamps and through the target; scene units if the
/// irradiance has no unit.
struct IncidentBand {
  struct Parts {
    double total = 0, direct = 0;
    double diffuse() const { return total - direct; }
  };
  Interval nm;    ///< where the band's response is not 0
  Parts energy;   ///< W/m^2; with lamps W
  Parts photons;  ///< umol/(m^2 s); with lamps umol/s
};

/// Light that an organ absorbs in a band, and that falls on it on either side, as shares of all incident light.
struct OrganShare {
  MeanError energy, direct;  ///< `direct`: the part of the energy from direct light
  MeanError photons;
  MeanError incident_energy, incident_photons;
};

/// Light budget by energy and photons. All vectors are by band.
struct EnergyBudget {
  struct OfMaterial {
    std::string name;
    std::vector<EnergyShare> absorbed, incident;  ///< as in FluxMeasurement::OfMaterial
  };
  /// Leaf area that the sun reaches, or does not reach, or all of it.
  struct OfLeaves {
    std::vector<EnergyShare> absorbed, incident;
  };
  std::vector<IncidentBand> incident;
  std::vector<EnergyShare> reflected, transmitted;
  std::vector<OfMaterial> materials;
  OfLeaves leaves, sunlit, shaded;  ///< empty if no material counts as a leaf; sunlit and shaded without a sun
  LeafArea leaf_area{};             ///< in the column of the target; with lamps of the scene
  std::vector<OrganShare> organs;   ///< by organ, then band; empty unless requested
  /// Sunlit share of the area of each organ: FluxMeter::sunlit_organs.
  std::vector<MeanError> sunlit_organs = {};
};

}  // namespace frond

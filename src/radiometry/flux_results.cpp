#include <algorithm>
#include <cmath>

#include "radiometry/flux_state.h"
#include "radiometry/photons.h"

namespace frond {
namespace {

/// Returns a mean of an organ; its error is NaN if no path was absorbed.
MeanError organ_mean(const Moment& moment, uint64_t paths) {
  MeanError mean = moment.mean(paths);
  if (moment.sum == 0) mean.standard_error = NAN;
  return mean;
}

}  // namespace

FluxMeasurement FluxMeter::read() const {
  const State& s = *state_;
  const auto bands = s.scene().wavelengths().bands();
  const auto shares = [&](size_t quantity) {
    std::vector<MeanError> result;
    for (size_t band = 0; band < s.bands; ++band) {
      const ExactMoment& all = s.moments[quantity * s.channels.count() + s.channels.energy(band, kAllLight)];
      result.push_back(all.value().mean(s.seen[band]));
    }
    return result;
  };
  FluxMeasurement measurement{.bands = {bands.begin(), bands.end()},
                              .reflected = shares(kReflected),
                              .transmitted = shares(kTransmitted),
                              .materials = {},
                              .sum = shares(kTotal),
                              .paths = paths(),
                              .target_area = has_lamps(s.scene().lights()) ? 1 : target_area(),
                              .by_organ = {},
                              .areas = {}};
  measurement.has_lamps = has_lamps(s.scene().lights());
  const std::vector<double> areas = areas_of_materials(s.scene().geometry(), s.materials);
  for (const uint32_t m : s.reflectors) {
    FluxMeasurement::OfMaterial one{s.loaded.description().materials[m].shown_name(),
                                    shares(flux_quantity(m, kAbsorbed)), shares(flux_quantity(m, kIncident)),
                                    shares(flux_quantity(m, kUncollided))};
    one.is_hit = std::ranges::any_of(one.incident, [](const MeanError& share) { return share.mean > 0; });
    if (!one.is_hit)
      for (auto* of_material : {&one.absorbed, &one.incident, &one.uncollided})
        for (MeanError& share : *of_material) share.standard_error = NAN;
    one.area = areas[m];
    measurement.materials.push_back(std::move(one));
  }
  if (s.channels.splits) measurement.energy = read_energy();
  if (!s.by_organ) return measurement;
  measurement.areas = s.organs->areas();
  if (s.channels.splits) {
    for (const OrganShare& share : measurement.energy->organs) measurement.by_organ.push_back(share.energy);
    return measurement;
  }
  measurement.by_organ.reserve(s.by_organ->size());
  for (size_t cell = 0; cell < s.by_organ->size(); ++cell)
    measurement.by_organ.push_back(organ_mean(s.by_organ->at(cell), s.seen[cell % s.bands]));
  return measurement;
}

EnergyBudget FluxMeter::read_energy() const {
  const State& s = *state_;
  const auto shares = [&s](size_t quantity) {
    std::vector<EnergyShare> result;
    for (size_t band = 0; band < s.bands; ++band) {
      const auto parts = [&](size_t first) {
        const auto mean = [&](LightPart part) {
          return s.moments[quantity * s.channels.count() + first + part].value().mean(s.seen[band]);
        };
        return LightParts{mean(kAllLight), mean(kDirectLight), mean(kDiffuseLight)};
      };
      result.push_back({parts(s.channels.energy(band, kAllLight)), parts(s.channels.photons(band, kAllLight))});
    }
    return result;
  };
  EnergyBudget budget;
  budget.reflected = shares(kReflected), budget.transmitted = shares(kTransmitted);
  for (size_t band = 0; band < s.bands; ++band) {
    const BandLight all = s.wavelengths.light(band), direct = s.wavelengths.direct_light(band);
    budget.incident.push_back(
        {s.ranges_nm[band],
         {all.energy, direct.energy},
         {all.energy * all.mean_nm / kPhotonEnergy, direct.energy * direct.mean_nm / kPhotonEnergy}});
  }
  for (const uint32_t m : s.reflectors)
    budget.materials.push_back({s.loaded.description().materials[m].shown_name(), shares(flux_quantity(m, kAbsorbed)),
                                shares(flux_quantity(m, kIncident))});
  if (!s.is_leaf.empty()) {
    const auto leaves = [&](FluxLeaves group) {
      return EnergyBudget::OfLeaves{shares(leaf_quantity(s.materials, group, kAbsorbed)),
                                    shares(leaf_quantity(s.materials, group, kIncident))};
    };
    budget.leaves = leaves(kAllLeaves);
    if (s.sun) budget.sunlit = leaves(kSunlitLeaves), budget.shaded = leaves(kShadedLeaves);
    budget.leaf_area = s.leaf_area;
  }
  if (!s.by_organ) return budget;
  for (size_t cell = 0; cell < s.by_organ->size(); cell += kOrganChannels) {
    const uint64_t paths = s.seen[cell / kOrganChannels % s.bands];
    const auto absorbed = [&](size_t channel) { return organ_mean(s.by_organ->at(cell + channel), paths); };
    const auto incident = [&](size_t channel) {
      const MeanError mean = organ_mean(s.by_organ->at(cell + channel), paths);
      return MeanError{mean.mean / kIncidentScale, mean.standard_error / kIncidentScale};
    };
    budget.organs.push_back({absorbed(kOrganEnergy), absorbed(kOrganDirect), absorbed(kOrganPhotons),
                             incident(kOrganIncident), incident(kOrganIncidentPhotons)});
  }
  return budget;
}

}  // namespace frond

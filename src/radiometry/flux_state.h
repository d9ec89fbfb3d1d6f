#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "radiometry/flux.h"
#include "radiometry/flux_sums.h"
#include "radiometry/incident_light.h"
#include "radiometry/lit_bands.h"
#include "radiometry/radiometer_scene.h"

namespace frond {

/// State of a measurement: flux.cpp prepares it, flux_paths.cpp adds paths to it, flux_results.cpp reads it.
struct FluxMeter::State {
  LoadedScene loaded;
  EntryBox entry;
  IncidentLight light;
  LitBands wavelengths;
  size_t materials, bands;
  FluxChannels channels;
  std::vector<uint8_t> is_leaf;           ///< by material index; empty: leaves are not measured apart
  std::vector<uint32_t> reflectors = {};  ///< indices of the materials of surfaces that light can hit
  std::vector<ExactMoment> moments = {};  ///< by quantity and channel
  std::vector<uint64_t> seen = {};        ///< number of paths, by band
  std::unique_ptr<Organs> organs = {};
  std::unique_ptr<OrganSums> by_organ = {};
  std::optional<Vec3> sun = {};          ///< direction toward the only sun
  std::vector<Interval> ranges_nm = {};  ///< of the bands, with splitting
  Interval optics_nm = {};               ///< of the scene's responses
  LeafArea leaf_area = {};
  uint64_t begin = 0, end = 0;  ///< numbers of the paths that have been traced
  /// Number of pairs of paths after which their bands repeat. Each turn has strata of its own, so that they are
  /// complete for each band.
  uint64_t turns = 1;

  size_t quantities() const {
    const size_t of_materials = kFirstOfMaterials + materials * kQuantitiesOfMaterial;
    return is_leaf.empty() ? of_materials : leaf_quantity(materials, kLeafGroups, kAbsorbed);
  }
  /// Moves wavelengths beyond the scene's responses to their ends.
  void limit_to_optics(SampledWavelengths& lambda) const {
    for (size_t lane = 0; lane < size_t(lambda.count); ++lane)
      lambda.nm[lane] = std::clamp(lambda.nm[lane], float(optics_nm.min), float(optics_nm.max));
  }
  size_t organ_channels() const { return channels.splits ? kOrganChannels * bands : bands; }
  const Scene& scene() const { return loaded.scene(); }
  /// Returns all accumulators as bytes.
  std::vector<std::span<const std::byte>> sums() const {
    std::vector<std::span<const std::byte>> arrays{std::as_bytes(std::span(moments)), std::as_bytes(std::span(seen))};
    if (by_organ) arrays.push_back(std::as_const(*by_organ).bytes());
    return arrays;
  }
};

}  // namespace frond

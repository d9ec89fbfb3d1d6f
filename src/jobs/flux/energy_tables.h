#pragma once

#include <optional>
#include <string>

#include "jobs/record/arguments.h"
#include "radiometry/flux.h"
#include "report/table.h"

/// Bands and tables of the job flux by energy (--bands).
namespace frond {

/// A band of --bands.
struct NamedRange {
  std::string name;
  Interval nm;
};

/// Returns the bands of --bands: par, nir, shortwave, all three of them, or NAME=FIRST:LAST. Throws InputError.
std::vector<NamedRange> band_ranges(const Arguments& args);
/// Returns the ranges, limited to those of the optics of surfaces, as a PluginText of `bands`.
std::string bands_text(const std::vector<NamedRange>& ranges, Interval optics_nm);

/// Returns a table with one row for each quantity and band: shares of the incident light, W/m^2 and umol/(m^2 s), also
/// of direct and of diffuse light; albedo, and fAPAR for the band from 400 to 700 nm. With lamps, W and umol/s.
Table energy_table(const FluxMeasurement& measurement);
/// Returns a table of the leaf area: all, sunlit and shaded, with the light on it, for each unit of its area.
/// `all_rows`: also rows of sunlit and shaded leaves without a sun: nothing is sunlit, or it is unknown.
Table leaf_table(const FluxMeasurement& measurement, bool all_rows);
/// Returns a table of the light on the surfaces of each material and that they absorb, for each unit of their area,
/// without materials of instances.
Table surface_energy_table(const FluxMeasurement& measurement);
/// Returns a table with one row for each organ: name, material, area, centre, and absorbed light as shares of the
/// incident light; if the measurement is by energy, absorbed and incident light for each unit of its area, and its
/// sunlit share.
Table organ_table(const FluxMeasurement& measurement, const Organs& organs);

/// Returns fAPAR: the share of the photons from 400 to 700 nm that leaves absorb; nullopt without such a band or
/// leaves.
std::optional<MeanError> fapar(const FluxMeasurement& measurement);

/// Writes a PLY file (binary, little endian) of all meshes. Faces have the light that their organ absorbs in each band,
/// as properties NAME_w_m2, NAME_umol_m2_s, and NAME_incident_ before these units, and `sunlit_share`; the first band
/// is also the property `quality`, and a colour. Vertices have the light and the colour, too. Returns the number of
/// surfaces that are left out, since they are no meshes. Throws InputError.
size_t write_organ_ply(const std::string& path, const FluxMeasurement& measurement, const Organs& organs);

}  // namespace frond

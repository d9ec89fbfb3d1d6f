#pragma once

#include <optional>

#include "radiometry/flux.h"
#include "radiometry/photons.h"
#include "report/table.h"

/// Tables of the job flux.
namespace frond {

/// Returns a table with one row for each quantity and band. Rows of PAR photons have no wavelength.
Table share_table(const FluxMeasurement& measurement, const std::optional<PhotonWeights>& photons);
/// Returns a text table with one row for each quantity and one column for each band.
std::string share_text(const FluxMeasurement& measurement, const std::optional<PhotonWeights>& photons);
/// Returns the column of an instance's absorption in a band: absorbed_550, absorbed_nir.
std::string absorption_column(const Band& band);
/// Returns the PAR photons that fall on the surfaces of each material, and that they absorb, for each unit of their
/// area, and its one-sided area; materials of instances are left out.
Table surface_table(const FluxMeasurement& measurement, const std::optional<PhotonWeights>& photons);
/// Returns a table with one row for each instance: area, absorbed photon flux (umol / (m2 s)), and absorbed shares of
/// the incident light. It is built by whole columns, because there may be 1e8 instances.
Table instance_table(const FluxMeasurement& measurement, const std::optional<PhotonWeights>& photons);

}  // namespace frond

#include "jobs/flux/flux_tables.h"

#include <algorithm>
#include <limits>

#include "jobs/support/radiometry.h"

namespace frond {
namespace {

/// One quantity of the light budget, by band.
struct ShareRow {
  std::string quantity, material;
  const std::vector<MeanError>& shares;
};

/// Returns the rows of the budget, in the order of the tables.
std::vector<ShareRow> share_rows(const FluxMeasurement& measurement) {
  std::vector<ShareRow> rows{{"reflected", "", measurement.reflected}, {"transmitted", "", measurement.transmitted}};
  for (const FluxMeasurement::OfMaterial& m : measurement.materials) rows.push_back({"absorbed", m.name, m.absorbed});
  rows.push_back({"sum", "", measurement.sum});
  for (const FluxMeasurement::OfMaterial& m : measurement.materials) rows.push_back({"incident", m.name, m.incident});
  for (const FluxMeasurement::OfMaterial& m : measurement.materials)
    rows.push_back({"uncollided", m.name, m.uncollided});
  return rows;
}

}  // namespace

std::string absorption_column(const Band& band) {
  return "absorbed_" + (band.name.empty() ? fmt::format("{:g}", band.nm) : band.name);
}

Table share_table(const FluxMeasurement& measurement, const std::optional<PhotonWeights>& photons) {
  Table table{"flux"};
  const auto add = [&table](const ShareRow& row, const Band& band, const MeanError& share) {
    table.add("quantity", row.quantity);
    table.add("material", row.material);
    add_band(table, band);
    table.add("share", share);
  };
  for (const ShareRow& row : share_rows(measurement)) {
    for (size_t band = 0; band < measurement.bands.size(); ++band) add(row, measurement.bands[band], row.shares[band]);
    if (photons) add(row, {std::numeric_limits<double>::quiet_NaN()}, photons->share(row.shares));
  }
  if (photons) std::ranges::find(table.columns, "wavelength_nm", &Column::name)->missing = "PAR";
  return table;
}

std::string share_text(const FluxMeasurement& measurement, const std::optional<PhotonWeights>& photons) {
  Table table{"flux"};
  for (const ShareRow& row : share_rows(measurement)) {
    table.add("share", row.quantity);
    table.add("material", row.material);
    if (photons) table.add("PAR photons", photons->share(row.shares));
    for (size_t band = 0; band < measurement.bands.size(); ++band)
      table.add(heading_of(measurement.bands[band]), row.shares[band]);
  }
  return to_text(table);
}

Table surface_table(const FluxMeasurement& measurement, const std::optional<PhotonWeights>& photons) {
  Table table{"surfaces"};
  for (const FluxMeasurement::OfMaterial& m : measurement.materials) {
    if (!photons || !(m.area > 0)) continue;
    const double factor = photons->incident * measurement.target_area / m.area;
    const auto by_area = [&](const std::vector<MeanError>& shares) {
      const MeanError share = photons->share(shares);
      return MeanError{share.mean * factor, share.standard_error * factor};
    };
    table.add("material", m.name);
    table.add("area", m.area);
    table.add("incident_umol_m2_s", by_area(m.incident));
    table.add("absorbed_umol_m2_s", by_area(m.absorbed));
  }
  return table;
}

Table instance_table(const FluxMeasurement& measurement, const std::optional<PhotonWeights>& photons) {
  const size_t bands = measurement.bands.size(), count = measurement.areas.size();
  Table table{"instances"};
  const auto add = [&](const std::string& name, const auto& value) {
    std::vector<double> values(count);
    for (size_t i = 0; i < count; ++i) values[i] = value(i);
    table.columns.push_back({name, std::move(values)});
  };
  const auto add_measured = [&](const std::string& name, const auto& value) {
    add(name, [&](size_t i) { return value(i).mean; });
    add(name + "_se", [&](size_t i) { return value(i).standard_error; });
  };
  add("instance", [](size_t i) { return double(i + 1); });
  add("area", [&](size_t i) { return double(measurement.areas[i]); });
  if (photons)
    add_measured("par_umol_m2_s", [&](size_t i) {
      const MeanError share = photons->share(std::span(measurement.by_organ).subspan(i * bands, bands));
      const double factor = photons->incident * measurement.target_area / double(measurement.areas[i]);
      return MeanError{share.mean * factor, share.standard_error * factor};
    });
  for (size_t band = 0; band < bands; ++band)
    add_measured(absorption_column(measurement.bands[band]),
                 [&](size_t i) { return measurement.by_organ[i * bands + band]; });
  return table;
}

}  // namespace frond

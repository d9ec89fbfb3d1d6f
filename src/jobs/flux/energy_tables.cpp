#include "jobs/flux/energy_tables.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <functional>

#include "instruments/errors/statistics.h"
#include "jobs/flux/flux_tables.h"

namespace frond {
namespace {

/// Bands that have a name (docs/radiometry.md).
struct KnownRange {
  std::string_view name;
  Interval nm;
};
constexpr KnownRange kPar{"par", {400, 700}};
constexpr KnownRange kKnown[] = {kPar, {"nir", {700, 1100}}, {"shortwave", {300, 2500}}};

/// Index of the band from 400 to 700 nm.
std::optional<size_t> par_band(const EnergyBudget& budget) {
  for (size_t band = 0; band < budget.incident.size(); ++band)
    if (budget.incident[band].nm.min == kPar.nm.min && budget.incident[band].nm.max == kPar.nm.max) return band;
  return {};
}

/// Appends the columns that name a band.
void add_range(Table& table, const FluxMeasurement& measurement, size_t band) {
  const Interval nm = measurement.energy->incident[band].nm;
  table.add("band", measurement.bands[band].name);
  table.add("first_nm", nm.min);
  table.add("last_nm", nm.max);
}

/// Appends the columns of light by origin, times `factor`: NAME, direct_NAME, diffuse_NAME.
void add_parts(Table& table, const std::string& name, const LightParts& parts, const IncidentBand::Parts& incident,
               double per_area = 1) {
  table.add(name, scaled(parts.total, incident.total * per_area));
  table.add("direct_" + name, scaled(parts.direct, incident.total * per_area));
  table.add("diffuse_" + name, scaled(parts.diffuse, incident.total * per_area));
}

/// Appends shares of all, of the direct and of the diffuse incident light.
void add_shares(Table& table, const LightParts& parts, const IncidentBand::Parts& incident) {
  table.add("share", parts.total);
  table.add("direct_share", divided(parts.direct, {incident.direct / incident.total, 0}));
  table.add("diffuse_share", divided(parts.diffuse, {incident.diffuse() / incident.total, 0}));
}

/// Of a ratio, which has no energy: missing values.
const LightParts kNoLight{{NAN, NAN}, {NAN, NAN}, {NAN, NAN}};

/// Marks columns, with their errors, that text for terminals omits.
void hide(Table& table, const std::vector<std::string>& names) {
  for (const std::string& name : names)
    for (const std::string& column : {name, name + "_se"})
      if (const auto found = std::ranges::find(table.columns, column, &Column::name); found != table.columns.end())
        found->only_data = true;
}

}  // namespace

/// Words are separated by commas: a list of Python is joined by them, too.
std::vector<NamedRange> band_ranges(const Arguments& args) {
  const std::string option = args.spelled("bands"), given = args.text("bands");
  const std::string text = given == "all" ? "par,nir,shortwave" : given;
  std::vector<NamedRange> ranges;
  for (size_t begin = 0; begin <= text.size();) {
    const size_t end = std::min(text.find(',', begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    begin = end + 1;
    const size_t equals = word.find('='), colon = word.find(':');
    NamedRange range{word.substr(0, equals), {}};
    if (equals == std::string::npos) {
      const auto* known = std::ranges::find(kKnown, word, &KnownRange::name);
      if (known == std::end(kKnown))
        fail({}, "{}: \"{}\" is none of par, nir and shortwave; NAME=FIRST:LAST gives a band in nm, as in blue=400:500",
             option, word);
      range.nm = known->nm;
    } else {
      const auto is_word = [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; };
      const auto limits =
          colon == std::string::npos || colon < equals
              ? std::nullopt
              : parse_numbers(word.substr(equals + 1, colon - equals - 1) + "," + word.substr(colon + 1));
      if (range.name.empty() || !std::ranges::all_of(range.name, is_word) || !limits || limits->size() != 2)
        fail({}, "{} takes NAME=FIRST:LAST in nm, as in blue=400:500: \"{}\" was given", option, word);
      range.nm = {(*limits)[0], (*limits)[1]};
      if (!(range.nm.min < range.nm.max && range.nm.min >= 300 && range.nm.max <= 2500))
        fail({}, "{}: {} from {:g} to {:g} nm is not a range within 300 to 2500 nm", option, range.name, range.nm.min,
             range.nm.max);
    }
    ranges.push_back(std::move(range));
  }
  return ranges;
}

/// The bands of the scene, in which its materials are prepared, may be narrower than those whose light is measured.
std::string bands_text(const std::vector<NamedRange>& ranges, Interval optics_nm) {
  std::string limits, names;
  for (const NamedRange& range : ranges) {
    Interval nm{std::max(range.nm.min, optics_nm.min), std::min(range.nm.max, optics_nm.max)};
    if (!(nm.min < nm.max)) {  // a band beyond the optics has their end
      const double end = range.nm.min < optics_nm.min ? optics_nm.min : optics_nm.max - 1;
      nm = {end, end + 1};
    }
    limits += fmt::format("{}{},{}", limits.empty() ? "" : ",", nm.min, nm.max);
    names += (names.empty() ? "" : ",") + range.name;
  }
  return "bands,ranges=" + limits + ",names=" + names;
}

/// Direct and diffuse parts share their paths, so that only the total of all leaf materials has the right error.
std::optional<MeanError> fapar(const FluxMeasurement& measurement) {
  const EnergyBudget& budget = *measurement.energy;
  const auto band = par_band(budget);
  if (!band || budget.leaves.absorbed.empty()) return {};
  return budget.leaves.absorbed[*band].photons.total;
}

Table energy_table(const FluxMeasurement& measurement) {
  const EnergyBudget& budget = *measurement.energy;
  Table table{"energy"};
  const bool lamps = measurement.has_lamps;
  const std::string watts = lamps ? "w" : "w_m2", photons = lamps ? "umol_s" : "umol_m2_s";
  // Direct and diffuse light are columns, so that a row has one quantity and band.
  const auto add_row = [&](const std::string& quantity, const std::string& material, size_t band,
                           const EnergyShare& share) {
    const IncidentBand& incident = budget.incident[band];
    table.add("quantity", quantity);
    table.add("material", material);
    add_range(table, measurement, band);
    add_shares(table, share.energy, incident.energy);
    add_parts(table, watts, share.energy, incident.energy);
    add_parts(table, photons, share.photons, incident.photons);
  };
  const auto add = [&](const std::string& quantity, const std::string& material,
                       const std::vector<EnergyShare>& shares) {
    for (size_t band = 0; band < shares.size(); ++band) add_row(quantity, material, band, shares[band]);
  };
  /// A ratio has a share alone.
  const auto add_ratio = [&](const std::string& quantity, size_t band, const LightParts& parts,
                             const IncidentBand::Parts& incident) {
    table.add("quantity", quantity);
    table.add("material", "");
    add_range(table, measurement, band);
    add_shares(table, parts, incident);
    for (const std::string& unit : {watts, photons}) add_parts(table, unit, kNoLight, {1, 1});
  };
  // The incident light is an integral over the lights' spectra and directions: it has no error of paths.
  for (size_t band = 0; band < budget.incident.size(); ++band) {
    const auto parts = [](const IncidentBand::Parts& p) {
      return LightParts{{1, 0}, {p.direct / p.total, 0}, {p.diffuse() / p.total, 0}};
    };
    const IncidentBand& incident = budget.incident[band];
    add_row("incident", "", band, {parts(incident.energy), parts(incident.photons)});
  }
  add("reflected", "", budget.reflected);
  add("transmitted", "", budget.transmitted);
  for (const EnergyBudget::OfMaterial& m : budget.materials) add("absorbed", m.name, m.absorbed);
  for (const EnergyBudget::OfMaterial& m : budget.materials) add("incident", m.name, m.incident);
  for (size_t band = 0; band < budget.incident.size() && !lamps; ++band)
    add_ratio("albedo", band, budget.reflected[band].energy, budget.incident[band].energy);
  if (const auto band = par_band(budget); band && !budget.leaves.absorbed.empty())
    add_ratio("fapar", *band, budget.leaves.absorbed[*band].photons, budget.incident[*band].photons);
  hide(table, {"first_nm", "last_nm", "direct_share", "diffuse_share", "direct_" + photons, "diffuse_" + photons});
  return table;
}

/// One row for each group of leaves and band. The area is that of one side, as for the leaf area index; light falls on
/// both. Light and area are measured with independent random numbers.
Table leaf_table(const FluxMeasurement& measurement, bool all_rows) {
  const EnergyBudget& budget = *measurement.energy;
  Table table{"leaves"};
  struct Row {
    const char* name;
    MeanError area;
    const EnergyBudget::OfLeaves& light;
  };
  const std::vector<EnergyShare> unknown(budget.incident.size(), {kNoLight, kNoLight}), zero(unknown.size());
  const EnergyBudget::OfLeaves of_unknown{unknown, unknown}, of_none{zero, zero};
  const MeanError& all = budget.leaf_area.all;
  std::vector<Row> rows{{"all", all, budget.leaves}};
  const bool is_dark =
      std::ranges::all_of(budget.incident, [](const IncidentBand& in) { return in.energy.direct == 0; });
  if (!budget.sunlit.absorbed.empty()) {
    rows.push_back({"sunlit", budget.leaf_area.sunlit, budget.sunlit});
    rows.push_back({"shaded", budget.leaf_area.shaded, budget.shaded});
  } else if (all_rows) {  // without direct light, nothing is sunlit
    rows.push_back({"sunlit", is_dark ? MeanError{} : MeanError{NAN, NAN}, is_dark ? of_none : of_unknown});
    rows.push_back({"shaded", is_dark ? all : MeanError{NAN, NAN}, is_dark ? budget.leaves : of_unknown});
  }
  for (const Row& row : rows)
    for (size_t band = 0; band < budget.incident.size(); ++band) {
      const IncidentBand& incident = budget.incident[band];
      const MeanError per_target = scaled(row.area, 1 / measurement.target_area);
      const EnergyShare &absorbed = row.light.absorbed[band], &received = row.light.incident[band];
      const auto add = [&](const std::string& name, const MeanError& share, double light) {
        table.add(name, &row.light == &of_none ? MeanError{} : divided(scaled(share, light), per_target));
      };
      table.add("leaves", row.name);
      table.add("area", row.area);
      if (!measurement.has_lamps) table.add("area_index", per_target);
      add_range(table, measurement, band);
      add("incident_w_m2", received.energy.total, incident.energy.total);
      add("absorbed_w_m2", absorbed.energy.total, incident.energy.total);
      add("absorbed_direct_w_m2", absorbed.energy.direct, incident.energy.total);
      add("absorbed_diffuse_w_m2", absorbed.energy.diffuse, incident.energy.total);
      add("incident_umol_m2_s", received.photons.total, incident.photons.total);
      add("absorbed_umol_m2_s", absorbed.photons.total, incident.photons.total);
    }
  hide(table, {"first_nm", "last_nm", "area", "absorbed_direct_w_m2", "absorbed_diffuse_w_m2", "incident_umol_m2_s"});
  return table;
}

Table surface_energy_table(const FluxMeasurement& measurement) {
  const EnergyBudget& budget = *measurement.energy;
  Table table{"surfaces"};
  for (size_t m = 0; m < budget.materials.size(); ++m)
    for (size_t band = 0; band < budget.incident.size(); ++band) {
      const double area = measurement.materials[m].area, per_area = measurement.target_area / area;
      if (!(area > 0)) continue;
      const EnergyBudget::OfMaterial& light = budget.materials[m];
      const IncidentBand& incident = budget.incident[band];
      table.add("material", light.name);
      table.add("area", area);
      add_range(table, measurement, band);
      table.add("incident_w_m2", scaled(light.incident[band].energy.total, incident.energy.total * per_area));
      table.add("absorbed_w_m2", scaled(light.absorbed[band].energy.total, incident.energy.total * per_area));
      table.add("incident_umol_m2_s", scaled(light.incident[band].photons.total, incident.photons.total * per_area));
      table.add("absorbed_umol_m2_s", scaled(light.absorbed[band].photons.total, incident.photons.total * per_area));
    }
  hide(table, {"first_nm", "last_nm"});
  return table;
}

/// It is built by whole columns, because there may be 1e8 triangles.
Table organ_table(const FluxMeasurement& measurement, const Organs& organs) {
  const size_t bands = measurement.bands.size();
  std::vector<size_t> shown;  // an organ without a surface is none: a material that is not used
  for (size_t i = 0; i < organs.size(); ++i)
    if (organs.kind() != OrganKind::material || organs.areas()[i] > 0) shown.push_back(i);
  Table table{std::string(kOrganPlurals[size_t(organs.kind())])};
  const auto add_numbers = [&](const std::string& name, const auto& value) {
    std::vector<double> values;
    for (const size_t i : shown) values.push_back(value(i));
    table.columns.push_back({name, std::move(values)});
  };
  const auto add_words = [&](const std::string& name, const auto& value) {
    std::vector<std::string> values;
    for (const size_t i : shown) values.emplace_back(value(i));
    table.columns.push_back({name, std::move(values)});
  };
  const auto add_measured = [&](const std::string& name, const auto& value) {
    add_numbers(name, [&](size_t i) { return value(i).mean; });
    add_numbers(name + "_se", [&](size_t i) { return value(i).standard_error; });
  };
  add_numbers(std::string(kOrganKinds[size_t(organs.kind())]), [](size_t i) { return double(i + 1); });
  add_words("name", [&](size_t i) { return organs.name(i + 1); });
  add_words("material_name", [&](size_t i) { return organs.material(i + 1); });
  if (organs.kind() != OrganKind::material && organs.kind() != OrganKind::instance)
    add_numbers("instance", [&](size_t i) { return double(organs.instance(i + 1)); });
  add_numbers("area", [&](size_t i) { return double(organs.areas()[i]); });
  add_numbers("x", [&](size_t i) { return organs.centers()[i].x; });
  add_numbers("y", [&](size_t i) { return organs.centers()[i].y; });
  add_numbers("z", [&](size_t i) { return organs.centers()[i].z; });
  for (size_t band = 0; band < bands; ++band) {
    if (!measurement.energy) {
      add_measured(absorption_column(measurement.bands[band]),
                   [&](size_t i) { return measurement.by_organ[i * bands + band]; });
      continue;
    }
    const IncidentBand& incident = measurement.energy->incident[band];
    const auto add = [&](const std::string& unit, MeanError OrganShare::*quantity, double light) {
      add_measured(measurement.bands[band].name + unit, [&, quantity, light](size_t i) {
        return scaled(measurement.energy->organs[i * bands + band].*quantity,
                      light * measurement.target_area / double(organs.areas()[i]));
      });
    };
    add("_w_m2", &OrganShare::energy, incident.energy.total);
    add("_direct_w_m2", &OrganShare::direct, incident.energy.total);
    add("_umol_m2_s", &OrganShare::photons, incident.photons.total);
    add("_incident_w_m2", &OrganShare::incident_energy, incident.energy.total);
    add("_incident_umol_m2_s", &OrganShare::incident_photons, incident.photons.total);
  }
  if (measurement.energy) add_measured("sunlit_share", [&](size_t i) { return measurement.energy->sunlit_organs[i]; });
  return table;
}

}  // namespace frond

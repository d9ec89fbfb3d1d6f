#include "jobs/flux/time_series.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "scene/format/plugin_text.h"
#include "spectra/sun_position.h"
#include "system/file_bytes.h"
#include "system/text_table.h"

namespace frond {
namespace {

/// Names of measured irradiances in pvlib and in weather data, and the parameters of the light "sky".
constexpr std::pair<std::string_view, std::string_view> kIrradiances[] = {
    {"ghi", "globalirradiance"}, {"dhi", "diffuseirradiance"}, {"dni", "directnormalirradiance"}};

bool is_measured_irradiance(const std::string& parameter) {
  return std::ranges::find(kIrradiances, parameter, &std::pair<std::string_view, std::string_view>::second) !=
         std::end(kIrradiances);
}

/// Sums of more rows, as those of leaves, are written to files only.
constexpr size_t kMostRowsOfText = 100;

/// Index of the light whose parameters the table has: the only sky, or else the only LightSource. Throws InputError.
size_t light_of(const JobRun& run, const SceneDescription& description) {
  std::vector<size_t> skies;
  for (size_t i = 0; i < description.lights.size(); ++i)
    if (description.lights[i].plugin.name == "sky") skies.push_back(i);
  if (skies.size() == 1) return skies[0];
  if (skies.empty() && description.lights.size() == 1) return 0;
  fail(description.lights.empty() ? Location{} : description.lights[0].plugin.where,
       "{} changes the parameters of one light, LightSource \"sky\" or the only LightSource; the scene has {}",
       run.args.spelled("times"),
       skies.empty() ? fmt::format("{}", description.lights.size()) : fmt::format("{} skies", skies.size()));
}

/// Rows of a table of times. Columns are found by their names, in any order.
class TimeRows {
 public:
  /// Warns of columns that are no parameters of `light`. Throws InputError for columns that are missing, given twice or
  /// exclude each other.
  TimeRows(std::string_view text, const std::string& path, const LightInfo& light, const Log& log)
      : table_(text, path), light_(light) {
    if (!table_.has_names()) fail(table_.names_where(), "the first line names the columns: time, ...");
    std::vector<std::string_view> known{"time", "latitude", "longitude", "sun_zenith", "sun_azimuth"};
    for (const Param& p : light.params) known.push_back(p.name);
    for (const auto& [name, parameter] : kIrradiances)
      if (find_param(light, parameter)) known.push_back(name);
    std::vector<std::string> unknown;
    for (size_t i = 0; i < table_.names().size(); ++i) {
      std::string name = name_without_unit(table_.names()[i].text);
      std::ranges::replace(name, ' ', '_');
      if (std::ranges::find(known, name) == known.end()) {
        if (!name.empty()) unknown.push_back('"' + name + '"' + suggestion(name, known));
        continue;
      }
      const auto as_parameter =
          std::ranges::find(kIrradiances, name, &std::pair<std::string_view, std::string_view>::first);
      if (as_parameter != std::end(kIrradiances)) name = as_parameter->second;
      if (!columns_.emplace(name, i).second) fail(table_.names_where(i), "there are two columns \"{}\"", name);
    }
    if (!has("time")) fail(table_.names_where(), "a column time is needed");
    for (const auto& [a, b] : {std::pair{"latitude", "longitude"}, {"sun_zenith", "sun_azimuth"}})
      if (has(a) != has(b)) fail(table_.names_where(), "the columns {} and {} belong together", a, b);
    const int suns = int(has("latitude")) + int(has("sun_zenith")) + int(has("elevation") || has("azimuth"));
    if (suns > 1)
      fail(table_.names_where(),
           "the sun's position is given twice: by latitude and longitude, sun_zenith and sun_azimuth, or elevation and "
           "azimuth");
    if (suns > 0 && !find_param(light, "elevation"))
      fail(table_.names_where(), "the light \"{}\" has no position of the sun: LightSource \"sky\" has", light.name);
    if (!unknown.empty())
      log.warn(table_.names_where(), fmt::format("column{} without effect, no parameter of light \"{}\": {}",
                                                 unknown.size() > 1 ? "s" : "", light.name, fmt::join(unknown, ", ")));
  }

  /// Reads the next step. Returns false at the end.
  bool next(TimeStep& step) {
    if (!table_.next()) return false;
    table_.check_fields();
    step = {.time = text("time")};
    const auto time = parse_time(step.time);
    if (!time) fail(table_.where(columns_.at("time")), "\"{}\" is no time, as 2026-06-21T11:00+02:00", step.time);
    step.seconds = 86400 * time->days_since_2000() - time->offset_seconds.value_or(0);
    step.date = fmt::format("{:04}-{:02}-{:02}", time->year, time->month, time->day);
    step.light = {std::string(light_.name), {}, table_.where()};
    add_sun(step, *time);
    for (const auto& [name, column] : columns_)
      if (!step.is_night && find_param(light_, name) && name != "elevation" && name != "azimuth")
        step.light.params.emplace_back(name, parameter(name));
    if (find_param(light_, "day") && !has("day"))
      step.light.params.emplace_back("day", fmt::format("{}", time->day_of_year()));
    step.is_night = step.is_night || is_dark();
    return true;
  }

 private:
  bool has(const std::string& name) const { return columns_.contains(name); }
  std::string text(const std::string& name) const { return std::string(table_.fields()[columns_.at(name)].text); }
  /// Throws InputError for text that is no finite number.
  double number(const std::string& name) const {
    const size_t field = columns_.at(name);
    const auto value = table_.number(table_.fields()[field].text);
    if (!value || !std::isfinite(*value))
      fail(table_.where(field), "the column {} needs a number, \"{}\" was given", name, table_.fields()[field].text);
    return *value;
  }
  /// Text of a parameter's value. Radiometers state a little less than 0 without light.
  std::string parameter(const std::string& name) const {
    constexpr double kNoise = 10;  // W m^-2
    if (find_param(light_, name)->kind == ParamKind::string) return text(name);
    const double value = number(name);
    return fmt::format("{}", is_measured_irradiance(name) && value < 0 && value > -kNoise ? 0 : value);
  }
  /// Adds the position of the sun, in a scene with +x to the east and +y to the north.
  void add_sun(TimeStep& step, const CivilTime& time) const {
    constexpr double kRight = 90;
    double elevation = 0, azimuth = 0;
    if (has("latitude")) {
      if (!time.offset_seconds)
        fail(table_.where(columns_.at("time")),
             "the position of the sun needs the time zone, as in 2026-06-21T11:00+02:00, or Z for UTC");
      const SunPosition sun = sun_position(step.seconds / 86400, number("latitude"), number("longitude"));
      elevation = sun.elevation, azimuth = kRight - sun.azimuth;
    } else if (has("sun_zenith")) {
      elevation = kRight - number("sun_zenith"), azimuth = kRight - number("sun_azimuth");
    } else if (has("elevation")) {
      elevation = number("elevation"), azimuth = has("azimuth") ? number("azimuth") : 0;
    } else {
      if (has("azimuth")) step.light.params.emplace_back("azimuth", parameter("azimuth"));
      return;
    }
    step.is_night = !(elevation > 0);
    step.elevation = elevation;
    step.light.params.emplace_back("elevation", fmt::format("{}", elevation));
    if (!has("elevation") || has("azimuth")) step.light.params.emplace_back("azimuth", fmt::format("{}", azimuth));
  }
  /// Whether the row states that there is no light.
  bool is_dark() const {
    const auto is_zero = [this](const std::string& name) { return has(name) && !(number(name) > 0); };
    return is_zero("globalirradiance") || is_zero("scale") ||
           (is_zero("diffuseirradiance") && is_zero("directnormalirradiance"));
  }

  TextTable table_;
  const LightInfo& light_;
  std::map<std::string, size_t> columns_;  ///< by name, measured irradiances by that of the parameter
};

/// Whether a column is measured, or the error of one, rather than a label of the row.
bool is_measured(const Table& table, const Column& column) {
  return column.is_number() && (column.name.ends_with("_se") || table.find(column.name + "_se"));
}

/// Appends the rows of a step. At night measured values are 0.
void append_step(const std::string& time, const Table& step, bool is_night, Table& all) {
  if (all.columns.empty()) {
    all.name = step.name;
    all.columns.push_back({"time", std::vector<std::string>{}});
    for (const Column& c : step.columns) {
      all.columns.push_back(c);
      std::visit([](auto& values) { values.clear(); }, all.columns.back().values);
    }
  }
  auto& times = std::get<1>(all.columns[0].values);
  times.insert(times.end(), step.rows(), time);
  for (size_t i = 0; i < step.columns.size(); ++i) {
    const Column& from = step.columns[i];
    if (!from.is_number()) {
      auto& values = std::get<1>(all.columns[i + 1].values);
      values.insert(values.end(), std::get<1>(from.values).begin(), std::get<1>(from.values).end());
      continue;
    }
    auto& values = std::get<0>(all.columns[i + 1].values);
    const bool is_zero = is_night && is_measured(step, from);
    for (const double value : std::get<0>(from.values)) values.push_back(is_zero && !std::isnan(value) ? 0 : value);
  }
}

/// Seconds that each step stands for: half of the time to the steps before and after it. The first and the last one
/// stand for as much outside as inside.
std::vector<double> durations(const std::vector<TimeStep>& steps) {
  std::vector<double> result(steps.size());
  for (size_t i = 0; i < steps.size(); ++i) {
    const double before = i > 0 ? steps[i].seconds - steps[i - 1].seconds : 0;
    const double after = i + 1 < steps.size() ? steps[i + 1].seconds - steps[i].seconds : before;
    result[i] = ((i > 0 ? before : after) + after) / 2;
  }
  return result;
}

/// Units that are summed over a day, and those of the sums.
constexpr std::tuple<std::string_view, std::string_view, double> kSummed[] = {
    {"umol_m2_s", "mol_m2", 1e-6}, {"w_m2", "mj_m2", 1e-6}, {"umol_s", "mol", 1e-6}, {"w", "mj", 1e-6}};

/// Returns the sums over each day of the columns of photons and energy. All steps have the same rows and the same
/// random numbers: the sum of the standard errors is an upper bound.
Table sums_of_days(const Table& all, const std::vector<TimeStep>& steps, const std::string& name) {
  Table days{name};
  const size_t rows = all.rows() / steps.size();
  const std::vector<double> seconds = durations(steps);
  for (size_t begin = 0, end = 0; begin < steps.size(); begin = end) {
    while (end < steps.size() && steps[end].date == steps[begin].date) ++end;
    for (size_t row = 0; row < rows; ++row) {
      std::vector<std::pair<std::string, double>> sums;
      for (const Column& c : all.columns)
        for (const auto& [unit, of_day, factor] : kSummed) {
          const bool is_error = c.name.ends_with("_se");
          const std::string mean = is_error ? c.name.substr(0, c.name.size() - 3) : c.name;
          if (!c.is_number() || !(mean == unit || mean.ends_with("_" + std::string(unit)))) continue;
          double sum = 0;
          for (size_t k = begin; k < end; ++k) sum += std::get<0>(c.values)[k * rows + row] * seconds[k] * factor;
          sums.emplace_back(mean.substr(0, mean.size() - unit.size()) + std::string(of_day) + (is_error ? "_se" : ""),
                            sum);
        }
      if (std::ranges::all_of(sums, [](const auto& sum) { return std::isnan(sum.second); })) continue;
      days.add("date", steps[begin].date);
      for (size_t i = 1; i < all.columns.size(); ++i) {
        const Column& c = all.columns[i];
        if (is_measured(all, c) || c.name == "wavelength_nm") continue;
        std::visit([&](const auto& values) { days.add(c.name, values[row]); }, c.values);
      }
      for (const auto& [column, sum] : sums) days.add(column, sum);
    }
  }
  return days;
}

/// Returns the scene with the parameters of a step, which replace what the scene states in other words; at night
/// without the light.
SceneDescription at_step(const JobRun& run, const SceneDescription& description, size_t light, const TimeStep& step) {
  SceneDescription d = description;
  if (step.is_night) {
    d.lights.erase(d.lights.begin() + ptrdiff_t(light));
    return d;
  }
  ParsedPlugin& plugin = d.lights[light].plugin;
  const auto states = [&step](const auto& is_one) {
    return std::ranges::any_of(step.light.params, [&](const auto& param) { return is_one(param.first); });
  };
  const bool has_sun = states([](const std::string& name) { return name == "elevation"; });
  const bool has_irradiance = states(is_measured_irradiance);
  std::erase_if(plugin.params, [&](const ParsedParam& p) {
    return (has_sun && p.name == "sundirection") || (has_irradiance && is_measured_irradiance(p.name));
  });
  set_params(step.light, run.session().registry().lights.get(plugin.name, plugin.where), step.light.where, plugin);
  return d;
}

/// Returns a fact of a result, NaN if it has none.
double number_of(const Result& result, std::string_view name) {
  for (const Fact& fact : result.facts)
    if (const double* value = fact.name == name ? std::get_if<double>(&fact.value) : nullptr) return *value;
  return std::numeric_limits<double>::quiet_NaN();
}

constexpr const char* kIncidentPar = "par_umol_m2_s";

/// Adds the photons of the rows of PAR, which have no wavelength, to a table of shares.
void add_photons(double incident, Table& table) {
  const Column* nm = table.find("wavelength_nm");
  const Column *share = table.find("share"), *error = table.find("share_se");
  if (!nm || !share || !error || std::isnan(incident)) return;
  constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
  Column mean{kIncidentPar, std::vector<double>{}}, se{std::string(kIncidentPar) + "_se", std::vector<double>{}};
  for (size_t i = 0; i < nm->size(); ++i) {
    const bool is_par = std::isnan(std::get<0>(nm->values)[i]);
    std::get<0>(mean.values).push_back(is_par ? std::get<0>(share->values)[i] * incident : kMissing);
    std::get<0>(se.values).push_back(is_par ? std::get<0>(error->values)[i] * incident : kMissing);
  }
  table.columns.push_back(std::move(mean));
  table.columns.push_back(std::move(se));
}

/// Returns the incident photons of each day, mol m^-2. `umol_m2_s`: of each step.
std::map<std::string, double> photons_of_days(const std::vector<TimeStep>& steps,
                                              const std::vector<double>& umol_m2_s) {
  const std::vector<double> seconds = durations(steps);
  std::map<std::string, double> days;
  for (size_t i = 0; i < steps.size(); ++i) days[steps[i].date] += umol_m2_s[i] * seconds[i] * 1e-6;
  return days;
}

/// Adds the shares of the incident photons to sums of days.
void add_shares(const std::map<std::string, double>& incident, Table& days) {
  const Column *par = days.find("par_mol_m2"), *error = days.find("par_mol_m2_se");
  if (incident.empty() || !par || !error) return;
  Column share{"share", std::vector<double>{}}, share_error{"share_se", std::vector<double>{}};
  for (size_t i = 0; i < days.rows(); ++i) {
    const double photons = incident.at(std::get<1>(days.columns[0].values)[i]);
    std::get<0>(share.values).push_back(std::get<0>(par->values)[i] / photons);
    std::get<0>(share_error.values).push_back(std::get<0>(error->values)[i] / photons);
  }
  days.columns.push_back(std::move(share));
  days.columns.push_back(std::move(share_error));
}

/// Returns the single values of each step; those of steps at night are 0.
Table table_of_steps(const TimeSeries& series, const std::vector<std::optional<Result>>& results, const Result& lit) {
  Table table{"steps"};
  for (size_t i = 0; i < series.steps.size(); ++i) {
    const TimeStep& step = series.steps[i];
    table.add("time", step.time);
    if (step.elevation) table.add("elevation_deg", *step.elevation);
    for (const Fact& fact : lit.facts)
      if (std::holds_alternative<double>(fact.value) && fact.name != "target_area")
        table.add(fact.name, results[i] ? number_of(*results[i], fact.name) : 0);
  }
  return table;
}

}  // namespace

TimeSeries read_time_series(const JobRun& run, const SceneDescription& description) {
  TimeSeries series{light_of(run, description), {}};
  const std::string path = run.args.text("times"), text = read_file_bytes(path, {});
  const ParsedPlugin& light = description.lights[series.light].plugin;
  TimeRows rows(text, path, run.session().registry().lights.get(light.name, light.where), run.log());
  for (TimeStep step; rows.next(step);) {
    if (!series.steps.empty() && !(step.seconds > series.steps.back().seconds))
      fail(step.light.where, "the times must ascend: {} follows {}", step.time, series.steps.back().time);
    series.steps.push_back(step);
  }
  if (series.steps.empty()) fail({std::make_shared<const std::string>(path)}, "the table has no rows");
  return series;
}

Result measure_times(const JobRun& run, const TimeSeries& series, const SceneDescription& description,
                     const std::function<Result(const SceneDescription&)>& measure) {
  std::vector<std::optional<Result>> results(series.steps.size());
  const bool has_others = description.lights.size() > 1 || !description.area_lights.empty();
  const Result* lit = nullptr;
  for (size_t i = 0; i < series.steps.size(); ++i) {
    const TimeStep& step = series.steps[i];
    run.log().info(step.time + (!step.is_night ? "" : has_others ? ": the other lights" : ": no light"));
    if (step.is_night && !has_others) continue;
    Result& result = results[i].emplace(measure(at_step(run, description, series.light, step)));
    if (result.stopped) return {.stopped = true};
    for (Table& table : result.tables) add_photons(number_of(result, kIncidentPar), table);
    if (!lit) lit = &result;
  }
  if (!lit)
    fail({std::make_shared<const std::string>(run.args.text("times"))},
         "there is no light at any of the {} times: nothing to measure", series.steps.size());
  Result all;
  for (const Table& table : lit->tables) {
    const size_t t = size_t(&table - lit->tables.data());
    Table& of_all = all.tables.emplace_back();
    for (size_t i = 0; i < results.size(); ++i)
      append_step(series.steps[i].time, results[i] ? results[i]->tables[t] : table, !results[i], of_all);
  }
  const size_t measured = all.tables.size();
  all.tables.push_back(table_of_steps(series, results, *lit));
  all.text = to_text(all.tables.back());
  const Table& steps = all.tables.back();
  std::map<std::string, double> incident;
  if (const Column* par = steps.find(kIncidentPar)) {
    incident = photons_of_days(series.steps, std::get<0>(par->values));
    std::vector<double> days;
    for (const auto& [date, photons] : incident) days.push_back(photons);
    all.facts.push_back({"par_mol_m2", days});
  }
  for (size_t t = 0; t < measured; ++t) {
    Table days = sums_of_days(all.tables[t], series.steps, all.tables[t].name + "_days");
    if (days.columns.empty()) continue;
    if (days.find("quantity")) add_shares(incident, days);
    if (days.rows() < kMostRowsOfText) all.text += '\n' + to_text(days);
    all.tables.push_back(std::move(days));
  }
  all.csv_tables = all.tables.size();
  for (const Fact& fact : lit->facts)
    if (fact.name == "target_area" || std::holds_alternative<std::string>(fact.value)) all.facts.push_back(fact);
  return all;
}

}  // namespace frond

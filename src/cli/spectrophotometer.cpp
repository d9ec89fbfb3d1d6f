#include "instruments/spectrophotometer.h"

#include <CLI/CLI.hpp>

#include "cli/commands.h"
#include "cli/common_options.h"
#include "cli/instrument.h"
#include "cli/number_list.h"
#include "report/chart.h"
#include "report/share_tables.h"
#include "report/text_output.h"

namespace frond {
namespace {

struct SpectrophotometerOptions : InstrumentOptions {
  double standard_error = 0;
};

/// A standard error alone asks for as many rays as it takes, up to a thousand million.
Dose dose_of(const SpectrophotometerOptions& o) {
  const std::string rays = !o.rays.empty() ? o.rays : o.standard_error > 0 ? "1e9" : "1e6";
  return {parse_count("--rays", rays, 2), o.standard_error};
}

std::vector<LabelledReading> measure(const InstrumentBench& bench, const Dose& dose, bool quiet) {
  std::vector<LabelledReading> readings;
  InstrumentProgress progress(bench.size(), dose.rays, quiet);
  for (size_t i = 0; i < bench.size(); ++i) {
    progress.start(i);
    readings.push_back(
        {bench.specimen(i).label(), measure_shares(bench.exposure(i), dose, bench.pool(), std::ref(progress))});
  }
  return readings;
}

void warn_where_not_reached(const InstrumentBench& bench, const Dose& dose,
                            const std::vector<LabelledReading>& readings) {
  size_t missed = 0;
  for (const auto& r : readings) missed += r.reading.standard_error() > dose.standard_error;
  if (dose.standard_error > 0 && missed > 0)
    bench.log().warn({}, fmt::format("{} of {} readings stopped at {} rays before their standard error came down to {}",
                                     missed, readings.size(), dose.rays, dose.standard_error));
}

void run_spectrophotometer(const SpectrophotometerOptions& o) {
  const Dose dose = dose_of(o);
  const InstrumentBench bench(o);
  if (!o.plot.empty())
    check_shares_chart(bench.specimens().size(), bench.angles_deg().size(), bench.wavelengths_nm().size());
  const auto readings = measure(bench, dose, o.quiet);
  warn_where_not_reached(bench, dose, readings);
  const auto notes = instrument_notes("spectrophotometer", o, bench);
  if (!o.csv.empty()) write_text(o.csv, shares_csv(notes, readings));
  if (!o.json.empty()) write_text(o.json, shares_json(notes, readings));
  if (!o.plot.empty()) write_chart(o.plot, shares_chart(readings));
  if (o.csv.empty() && o.json.empty() && !o.quiet) write_text("-", shares_text(readings));
}

}  // namespace

void add_spectrophotometer_command(CLI::App& app) {
  auto* command =
      app.add_subcommand("spectrophotometer", "Measure a material's reflectance, transmittance and absorptance.");
  auto o = std::make_shared<SpectrophotometerOptions>();
  add_instrument_options(*command, *o);
  command->add_option("--rays", o->rays, "Rays for each reading: 1e6 by default; with --se the most, 1e9 by default.");
  command->add_option("--se", o->standard_error, "Stop when the standard errors of R, T and A are no larger than this.")
      ->check(is_positive);
  command->add_option("--plot", o->plot, "Chart of R and 1 - T against wavelength or angle, .svg or .png.")
      ->type_name("FILE");
  command->callback([o] { run_spectrophotometer(*o); });
}

}  // namespace frond

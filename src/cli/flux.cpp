#include "radiometry/flux.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>

#include "cli/commands.h"
#include "cli/number_list.h"
#include "cli/progress.h"
#include "cli/radiometer_options.h"
#include "cli/strict_log.h"
#include "radiometry/photons.h"
#include "report/text_output.h"
#include "spectra/named.h"
#include "spectra/spd_file.h"

namespace frond {
namespace {

struct FluxOptions : RadiometerOptions {
  std::string by, irradiance = "solar-am1.5-global";
};

/// One line of the answer: what becomes of the light.
struct Row {
  std::string quantity, material;
  const std::vector<FluxShare>& shares;
};

std::vector<Row> rows_of(const FluxReading& reading) {
  std::vector<Row> rows{{"reflected", "", reading.reflected}, {"transmitted", "", reading.transmitted}};
  for (const FluxReading::OfMaterial& m : reading.materials) rows.push_back({"absorbed", m.name, m.absorbed});
  rows.push_back({"sum", "", reading.sum});
  for (const FluxReading::OfMaterial& m : reading.materials) rows.push_back({"incident", m.name, m.incident});
  for (const FluxReading::OfMaterial& m : reading.materials) rows.push_back({"uncollided", m.name, m.uncollided});
  return rows;
}

/// Of photons: the error is at most this, for bands share their paths.
FluxShare share_of_photons(std::span<const FluxShare> shares, const PhotonWeights& photons) {
  FluxShare sum;
  for (size_t band = 0; band < shares.size(); ++band) {
    sum.mean += photons.weights[band] * shares[band].mean;
    sum.standard_error += photons.weights[band] * shares[band].standard_error;
  }
  return sum;
}

std::string csv_of(const FluxReading& reading, const std::optional<PhotonWeights>& photons) {
  std::string text = "quantity,material,wavelength_nm,share,share_se\n";
  for (const Row& row : rows_of(reading)) {
    for (size_t band = 0; band < reading.wavelengths_nm.size(); ++band)
      text += fmt::format("{},{},{:g},{:.7g},{:.3g}\n", row.quantity, csv_field(row.material),
                          reading.wavelengths_nm[band], row.shares[band].mean, row.shares[band].standard_error);
    if (!photons) continue;
    const FluxShare par = share_of_photons(row.shares, *photons);
    text +=
        fmt::format("{},{},PAR,{:.7g},{:.3g}\n", row.quantity, csv_field(row.material), par.mean, par.standard_error);
  }
  return text;
}

std::string table_of(const FluxReading& reading, const std::optional<PhotonWeights>& photons) {
  std::string text = fmt::format("{:<12}{:<16}", "share", "");
  if (photons) text += fmt::format("{:>18}", "PAR photons");
  for (const double nm : reading.wavelengths_nm) text += fmt::format("{:>18}", fmt::format("{:g} nm", nm));
  text += '\n';
  const auto cell = [](const FluxShare& s) {
    return fmt::format("  {:7.5f} ±{:.5f}", s.mean + 0.0 == 0 ? 0.0 : s.mean, s.standard_error);
  };
  for (const Row& row : rows_of(reading)) {
    text += fmt::format("{:<12}{:<16}", row.quantity, row.material);
    if (photons) text += cell(share_of_photons(row.shares, *photons));
    for (const FluxShare& s : row.shares) text += cell(s);
    text += '\n';
  }
  return text;
}

/// A row for each copy: its area, the light that it absorbs as a share of what falls in, and by photons.
std::string instances_csv(const FluxReading& reading, const std::optional<PhotonWeights>& photons) {
  const size_t bands = reading.wavelengths_nm.size();
  std::string text = "instance,area";
  if (photons) text += ",par_umol_m2_s,par_umol_m2_s_se";
  for (const double nm : reading.wavelengths_nm) text += fmt::format(",absorbed_{0:g},absorbed_{0:g}_se", nm);
  text += '\n';
  for (size_t i = 0; i < reading.by_instance.size() / bands; ++i) {
    fmt::format_to(std::back_inserter(text), "{},{:.6g}", i + 1, reading.areas[i]);
    if (photons) {
      const FluxShare par = share_of_photons(std::span(reading.by_instance).subspan(i * bands, bands), *photons);
      const double factor = photons->incident * reading.target_area / double(reading.areas[i]);
      fmt::format_to(std::back_inserter(text), ",{:.6g},{:.3g}", par.mean * factor, par.standard_error * factor);
    }
    for (size_t band = 0; band < bands; ++band) {
      const FluxShare& s = reading.by_instance[i * bands + band];
      fmt::format_to(std::back_inserter(text), ",{:.6g},{:.3g}", s.mean, s.standard_error);
    }
    text += '\n';
  }
  return text;
}

/// Writes a checkpoint where the last one is long ago.
std::function<void()> keeper(const FluxOptions& o, const FluxMeter& meter, const KeptFile& kept, const Log& log) {
  using Clock = std::chrono::steady_clock;
  const std::chrono::duration<double> interval(o.checkpoint_seconds > 0 ? o.checkpoint_seconds : KeptFile::kSeconds);
  return [&meter, &kept, &log, interval, last = Clock::now()]() mutable {
    if (Clock::now() - last < interval) return;
    try {
      meter.save(kept.checkpoint());
    } catch (const InputError& error) {
      log.warn({}, fmt::format("no checkpoint was written, measuring goes on: {}", error.what()));
    }
    last = Clock::now();
  };
}

/// Traces until there are as many paths, or as small an error, as asked for, or the time is over. Nothing where it was
/// stopped; `kept` may be nullptr.
std::optional<FluxReading> measure(const FluxOptions& o, FluxMeter& meter, Session& session, const KeptFile* kept) {
  using Clock = std::chrono::steady_clock;
  ProgressLine line(o.quiet);
  RenderControl control{.progress = &line};
  if (o.time_limit_seconds > 0)
    control.deadline =
        Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(o.time_limit_seconds));
  constexpr uint64_t kFirst = 1 << 16, kMost = uint64_t{1} << 40;
  uint64_t paths = o.rms > 0 ? kFirst : uint64_t(parse_count("--paths", o.paths, 1));
  std::function<void()> keep;
  if (kept) {
    control.stop = kept->stop();
    if (const auto path = kept->found(o.resume)) meter.resume(*path);
    keep = keeper(o, meter, *kept, session.log());
  }
  if (o.rms > 0)  // whoever has more has looked at fewer, and has gone on
    while (paths < meter.paths()) paths *= 2;
  for (;; paths *= 2) {
    if (meter.paths() < paths) meter.trace(paths - meter.paths(), session.pool(), control, keep);
    const bool stopped = control.stop.stop_requested();
    if (stopped) kept->keep(false, false, [&meter](const auto& path) { meter.save(path); });
    if (stopped) return {};
    FluxReading reading = meter.read();
    if (reading.paths == 0) fail({}, "--time-limit: the time was over before any light was followed");
    const bool is_over = control.deadline && Clock::now() >= *control.deadline;
    if (!is_over && o.rms > 0 && reading.error() > o.rms && paths < kMost) continue;
    if (kept) kept->keep(true, false, [&meter](const auto& path) { meter.save(path); });
    return reading;
  }
}

std::vector<double> bands_of(const Scene& scene) {
  std::vector<double> nm;
  for (const Band& band : scene.wavelengths().bands()) nm.push_back(band.nm);
  return nm;
}

/// Returns the program's exit code.
int run_flux(const FluxOptions& o) {
  const ConsoleLog console(o.quiet);
  const StrictLog log(console, o.reading.strict);
  if (!o.csv.empty()) check_text_output(o.csv);
  const auto kept = kept_file_of(o, log);
  Session session(log, session_options_of(o));
  const SpectrumPtr irradiance =
      o.irradiance.ends_with(".spd") ? read_spd(o.irradiance, {}) : named_spectrum(o.irradiance, {});
  const bool by_instance = o.by == "instance";
  FluxMeter meter(session, scene_of(o, session),
                  {target_of(o), period_of(o), wavelengths_of(o), by_instance, !o.integrator.empty()});
  log.check();
  const auto photons = PhotonWeights::of(bands_of(meter.scene()), *irradiance);
  const auto measured = measure(o, meter, session, kept.get());
  if (!measured) return kept->say_how_to_go_on();
  const FluxReading& reading = *measured;
  if (by_instance && !photons)
    log.info("no PAR: it takes bands from 400 to 700 nm, in steps of 50 nm at most (--wavelengths 400:700:20)");
  if (by_instance)
    write_text(o.csv.empty() ? "-" : o.csv, instances_csv(reading, photons));
  else
    write_text(o.csv.empty() ? "-" : o.csv, o.csv.empty() ? table_of(reading, photons) : csv_of(reading, photons));
  log.info(fmt::format("{} paths; standard errors {:.2g} (RMS)", reading.paths, reading.error()));
  return 0;
}

}  // namespace

void add_flux_command(CLI::App& app) {
  auto o = std::make_shared<FluxOptions>();
  auto* command = app.add_subcommand("flux", "Measure where the light that falls on a scene goes.");
  o->paths = "1e6";
  add_radiometer_options(*command, *o, "Paths of light: 1e6 by default.");
  command->add_option("--by", o->by, "instance: a row for each copy of an object.")->check(CLI::IsMember({"instance"}));
  command->add_option("--irradiance", o->irradiance,
                      "Of the horizontal plane, W/(m2 nm), for photons: a spectrum's name or an .spd file; "
                      "solar-am1.5-global by default.");
  command->callback([o] {
    const int code = run_flux(*o);
    if (code != 0) throw CLI::RuntimeError(code);
  });
}

}  // namespace frond

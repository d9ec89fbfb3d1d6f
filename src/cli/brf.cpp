#include "radiometry/brf.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <memory>

#include "cli/commands.h"
#include "cli/common_options.h"
#include "cli/number_list.h"
#include "cli/progress.h"
#include "cli/radiometer_options.h"
#include "cli/strict_log.h"
#include "radiometry/brf_comparison.h"
#include "render/part_file.h"
#include "report/brf_chart.h"
#include "report/chart.h"
#include "report/text_output.h"
#include "study/compare/candidate.h"
#include "system/cpu_clock.h"

namespace frond {
namespace {

struct BrfOptions : RadiometerOptions {
  std::string zenith = "-75:75:5", azimuth = "0", plot;
  std::vector<std::string> compare;
  std::string reference = "leaf_solved";
  double within = 0.02;
  bool hemisphere = false;
};

/// A leaf model's BRF, and what it took.
struct ModelReading {
  compare::Candidate model;
  BrfReading brf;
  double cpu_us_per_path = 0;
};

/// Every direction of a hemisphere: rings of even steps.
std::vector<ViewDirection> hemisphere() {
  constexpr int kZenithStep = 5, kLast = 85, kAzimuthStep = 15;
  std::vector<ViewDirection> views{{0, 0}};
  for (int zenith = kZenithStep; zenith <= kLast; zenith += kZenithStep)
    for (int azimuth = 0; azimuth < 360; azimuth += kAzimuthStep) views.push_back({double(zenith), double(azimuth)});
  return views;
}

std::vector<ViewDirection> views_of(const BrfOptions& o) {
  if (o.hemisphere) return hemisphere();
  std::vector<ViewDirection> views;
  for (const double azimuth : parse_numbers("--azimuth", o.azimuth))
    for (const double zenith : parse_numbers("--zenith", o.zenith)) {
      if (!(std::abs(zenith) < 90)) fail({}, "--zenith: {:g} is not above the horizon, which is at 90", zenith);
      views.push_back({zenith, azimuth});
    }
  return views;
}

std::string differences_csv(const ModelReading& reference, const std::vector<ModelReading>& models) {
  std::string text =
      "model,zenith_deg,azimuth_deg,wavelength_nm,brf,brf_se,relative_difference,relative_difference_se\n";
  const auto add = [&](const ModelReading& m) {
    const auto differences = relative_to(reference.brf, m.brf);
    const size_t bands = m.brf.wavelengths_nm.size();
    for (size_t i = 0; i < differences.size(); ++i)
      text += fmt::format("{},{:g},{:g},{:g},{:.6g},{:.3g},{:.5g},{:.3g}\n", csv_field(m.model.label),
                          m.brf.views[i / bands].zenith_deg, m.brf.views[i / bands].azimuth_deg,
                          m.brf.wavelengths_nm[i % bands], m.brf.values[i].mean, m.brf.values[i].standard_error,
                          differences[i].mean, differences[i].standard_error);
  };
  add(reference);
  for (const ModelReading& m : models) add(m);
  return text;
}

/// A line for each model, the cheapest first, and which of them is enough.
std::string verdict_of(const ModelReading& reference, const std::vector<ModelReading>& models, double within) {
  using Answer = BrfVerdict::Answer;
  std::string text = fmt::format("BRF relative to {} ({:.2f} µs a path), within {:g} % everywhere?\n",
                                 reference.model.label, reference.cpu_us_per_path, 100 * within);
  const ModelReading* enough = nullptr;
  for (const ModelReading& m : models) {
    const BrfVerdict v = judge(reference.brf, m.brf, within);
    const char* answer = v.answer == Answer::enough       ? "yes"
                         : v.answer == Answer::not_enough ? "no"
                         : m.brf.has_heavy_tails          ? "not known: its noise has no bound"
                                                          : "not known: more paths tell";
    text += fmt::format("  {:<24} {:6.2f} µs a path  {:+8.2f} ±{:.2f} % at {:g}°, {:g} nm; {:.2f} % at most: {}\n",
                        m.model.label, m.cpu_us_per_path, 100 * v.worst.mean, 100 * v.worst.standard_error,
                        m.brf.views[v.view].zenith_deg, m.brf.wavelengths_nm[v.band], 100 * v.upper, answer);
    if (v.answer == Answer::enough && !enough) enough = &m;
  }
  return text + fmt::format("Enough, and the cheapest: {}\n", enough ? enough->model.label : reference.model.label);
}

std::string csv_of(const BrfReading& reading) {
  std::string text = "zenith_deg,azimuth_deg,wavelength_nm,brf,brf_se\n";
  for (size_t view = 0; view < reading.views.size(); ++view)
    for (size_t band = 0; band < reading.wavelengths_nm.size(); ++band) {
      const BrfValue& v = reading.at(view, band);
      text += fmt::format("{:g},{:g},{:g},{:.6g},{:.3g}\n", reading.views[view].zenith_deg,
                          reading.views[view].azimuth_deg, reading.wavelengths_nm[band], v.mean, v.standard_error);
    }
  return text;
}

/// A row for each direction, a column for each wavelength.
std::string table_of(const BrfReading& reading) {
  std::string text = " zenith azimuth";
  for (const double nm : reading.wavelengths_nm) text += fmt::format("{:>17}", fmt::format("{:g} nm", nm));
  text += '\n';
  for (size_t view = 0; view < reading.views.size(); ++view) {
    text += fmt::format("{:7g} {:7g}", reading.views[view].zenith_deg, reading.views[view].azimuth_deg);
    for (size_t band = 0; band < reading.wavelengths_nm.size(); ++band)
      text += fmt::format("{:9.5f} ±{:.5f}", reading.at(view, band).mean, reading.at(view, band).standard_error);
    text += '\n';
  }
  return text;
}

/// Nothing, or what an earlier run has left. Throws InputError for what is of another measurement.
RenderPart first_part(const BrfOptions& o, const BrfMeter& meter, const KeptFile* kept) {
  RenderPart fresh = meter.scene().empty_part();
  const auto path = kept ? kept->found(o.resume) : std::nullopt;
  if (!path) return fresh;
  RenderPart part = read_part(*path);
  const std::string difference =
      fresh.header.identity.difference(part.header.identity, "this command", "\"" + path->string() + "\"");
  if (!difference.empty()) fail({}, "--resume: this is another measurement. {}", difference);
  return part;
}

/// Renders until there are as many paths, or as small an error, as asked for, or the time is over. Nothing where it was
/// stopped; `kept` may be nullptr.
std::optional<BrfReading> measure(const BrfOptions& o, const BrfMeter& meter, Session& session, const KeptFile* kept) {
  using Clock = std::chrono::steady_clock;
  ProgressLine line(o.quiet);
  RenderControl control{.progress = &line};
  if (o.time_limit_seconds > 0)
    control.deadline =
        Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(o.time_limit_seconds));
  constexpr uint64_t kFirst = 64, kMost = uint64_t{1} << 32;
  const uint64_t needed = meter.scene().scene().wavelengths().bands().size();
  const auto asked = uint64_t(parse_count("--paths", o.paths, 1, int64_t(kMost)));
  uint64_t samples = o.rms > 0 ? kFirst : (asked + BrfMeter::kRows - 1) / BrfMeter::kRows;
  samples = std::max(samples, needed);
  RenderPart part = first_part(o, meter, kept);
  if (o.rms > 0)  // whoever has more has looked at fewer, and has gone on
    while (samples < sample_count(part.film).most) samples *= 2;
  std::optional<Checkpointer> checkpointer;
  if (kept) {
    checkpointer.emplace(kept->checkpoint(), o.checkpoint_seconds > 0 ? o.checkpoint_seconds : KeptFile::kSeconds, part,
                         &line, session.log());
    control.progress = &*checkpointer;
    control.stop = kept->stop();
  }
  for (;; samples *= 2) {
    session.render(meter.scene(), {0, samples}, part, control);
    const bool is_over = control.deadline && Clock::now() >= *control.deadline;
    const bool stopped = control.stop.stop_requested();
    if (stopped) kept->keep(false, false, [&checkpointer](const auto&) { checkpointer->write(); });
    if (stopped) return {};
    if (is_over && sample_count(part.film).least == 0)
      fail({}, "--time-limit: the time was over before every direction had been seen");
    BrfReading reading = meter.read(part.film);
    if (!is_over && o.rms > 0 && reading.relative_error() > o.rms && samples < kMost) continue;
    if (kept) kept->keep(true, false, [&checkpointer](const auto&) { checkpointer->write(); });
    return reading;
  }
}

/// The scene with one leaf model in place of its leaves, and then with the others.
void run_comparison(const BrfOptions& o, const BrfRequest& request, const StrictLog& log) {
  Session session(log, session_options_of(o));
  const SceneDescription description = session.read(o.scene, unsupported_of(o.reading));
  std::unique_ptr<BrfMeter> first;
  const auto measured = [&](const compare::Candidate& model) {
    if (!model.wavelengths.empty() || model.integrator)
      fail({}, "--compare takes materials alone: \"{}\" has an @", model.text);
    SceneOverrides overrides = overrides_of(o);
    overrides.swaps.push_back({"*", model.material});
    auto meter =
        std::make_unique<BrfMeter>(session, description, overrides, request, first ? &first->scene().scene() : nullptr);
    log.check();
    const double start = cpu_seconds();
    ModelReading result{model, *measure(o, *meter, session, nullptr)};
    const double paths = double(result.brf.paths) * double(result.brf.views.size());
    result.cpu_us_per_path = (cpu_seconds() - start) * 1e6 / paths;
    if (!first) first = std::move(meter);
    return result;
  };
  const auto models = compare::parse_candidates(o.compare);
  const ModelReading reference = measured(compare::parse_candidate(o.reference));
  std::vector<ModelReading> readings;
  for (const compare::Candidate& model : models) readings.push_back(measured(model));
  std::ranges::sort(readings, {}, &ModelReading::cpu_us_per_path);
  if (!o.csv.empty()) write_text(o.csv, differences_csv(reference, readings));
  if (o.csv != "-") write_text("-", verdict_of(reference, readings, o.within));
}

/// Returns the program's exit code.
int run_brf(const BrfOptions& o) {
  const ConsoleLog console(o.quiet);
  const StrictLog log(console, o.reading.strict);
  if (!o.csv.empty()) check_text_output(o.csv);
  if (!o.plot.empty()) check_chart(o.plot);
  const BrfRequest request{views_of(o), target_of(o), period_of(o), wavelengths_of(o)};
  if (!o.compare.empty()) {
    if (!o.plot.empty()) fail({}, "--plot is of one model's BRF: --csv has those of --compare");
    if (o.checkpoint_seconds > 0 || o.resume) fail({}, "--checkpoint and --resume are of one model's BRF");
    run_comparison(o, request, log);
    return 0;
  }
  const auto kept = kept_file_of(o, log);
  Session session(log, session_options_of(o));
  const BrfMeter meter(session, session.read(o.scene, unsupported_of(o.reading)), overrides_of(o), request);
  log.check();
  const auto measured = measure(o, meter, session, kept.get());
  if (!measured) return kept->say_how_to_go_on();
  const BrfReading& reading = *measured;
  if (!o.csv.empty()) write_text(o.csv, csv_of(reading));
  if (o.csv.empty()) write_text("-", table_of(reading));
  if (!o.plot.empty()) write_chart(o.plot, o.hemisphere ? brf_hemisphere_chart(reading) : brf_plane_chart(reading));
  log.info(fmt::format("{} paths a direction; standard errors {:.2f} % of the BRF (RMS)", reading.paths,
                       100 * reading.relative_error()));
  if (o.rms > 0 && reading.relative_error() > o.rms) log.warn({}, fmt::format("--rms {:g} was not reached", o.rms));
  return 0;
}

}  // namespace

void add_brf_command(CLI::App& app) {
  auto o = std::make_shared<BrfOptions>();
  auto* command = app.add_subcommand("brf", "Measure a scene's bidirectional reflectance factor from far away.");
  add_radiometer_options(*command, *o, "Paths for each direction: 65536 by default.");
  command->add_option("--zenith", o->zenith,
                      "Degrees, as in -75:75:2; under one sun a negative zenith looks from its side.");
  command->add_option("--azimuth", o->azimuth,
                      "Degrees from the plane of the sun, or from +x toward +y where there is not one sun.");
  command->add_flag("--hemisphere", o->hemisphere, "Directions from everywhere above, every 5 and 15 degrees.");
  command->add_option("--plot", o->plot, "Chart against the zenith angle, or maps of a hemisphere: .svg or .png.")
      ->type_name("FILE");
  command
      ->add_option(
          "--compare", o->compare,
          "MODEL[,parameter=value...],... in place of the scene's leaves, as in frond compare: which is enough?")
      ->allow_extra_args(false);
  command->add_option("--reference", o->reference, "The model that counts as right; leaf_solved by default.")
      ->type_name("MATERIAL");
  command->add_option("--within", o->within, "Largest relative difference that is enough; 0.02 by default.")
      ->check(is_positive);
  command->callback([o] {
    const int code = run_brf(*o);
    if (code != 0) throw CLI::RuntimeError(code);
  });
}

}  // namespace frond

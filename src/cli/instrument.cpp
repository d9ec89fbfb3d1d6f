#include "cli/instrument.h"

#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <chrono>

#include "cli/common_options.h"
#include "cli/number_list.h"
#include "cli/progress.h"
#include "render/plugins.h"
#include "report/chart.h"
#include "report/text_output.h"

namespace frond {
namespace {

constexpr Interval kWavelengths_nm{360, 2500};

std::string joined(const std::vector<std::string>& parts) { return fmt::format("{}", fmt::join(parts, ",")); }

std::vector<double> angles_of(const InstrumentOptions& o) {
  const auto angles = parse_numbers("--angles", joined(o.angles));
  for (const double theta : angles) check_beam({theta, kWavelengths_nm.min});
  return angles;
}

std::vector<double> wavelengths_of(const InstrumentOptions& o) {
  const auto wavelengths = parse_numbers("--wavelengths", joined(o.wavelengths));
  for (const double nm : wavelengths)
    if (!kWavelengths_nm.contains(nm))
      fail({}, "--wavelengths: instruments work from {} to {} nm, {} was given", kWavelengths_nm.min,
           kWavelengths_nm.max, nm);
  return wavelengths;
}

void check_outputs(const InstrumentOptions& o) {
  if (o.csv == "-" && o.json == "-") fail({}, "only one of --csv and --json can go to standard output");
  if (!o.csv.empty()) check_text_output(o.csv);
  if (!o.json.empty()) check_text_output(o.json);
  if (!o.plot.empty()) check_chart(o.plot);
}

}  // namespace

void add_instrument_options(CLI::App& command, InstrumentOptions& o) {
  add_specimen_options(command, o);
  command
      .add_option("--angles,--angle", o.angles,
                  "Angles of incidence in degrees, 0,8,30 or first:last:step; 8 by default. Above 90 the back is lit.")
      ->allow_extra_args(false);
  command.add_option("--wavelengths,--wavelength", o.wavelengths, "Wavelengths in nm, 360 to 2500: a list or a range.")
      ->allow_extra_args(false)
      ->required();
  command.add_flag(
      "--rendered", o.as_rendered,
      "As a renderer shows the material: light along wi, seen along wo, though the model call wo incident.");
  command.add_option("--csv", o.csv, "Write CSV to a file, or - for standard output.")->type_name("FILE");
  command.add_option("--json", o.json, "Write JSON to a file, or - for standard output.")->type_name("FILE");
}

InstrumentBench::InstrumentBench(const InstrumentOptions& o)
    : pool_(o.threads),
      log_(o.quiet),
      seed_(o.seed),
      as_rendered_(o.as_rendered),
      angles_deg_(angles_of(o)),
      wavelengths_nm_(wavelengths_of(o)) {
  check_outputs(o);
  const Registry registry = load_registry(o.plugins);
  for (const auto& words : specimen_words(o))
    specimens_.emplace_back(words, registry, wavelengths_nm_, pool_, log_, cache_directory(o.cache, o.no_cache));
  check_exposures();
}

void InstrumentBench::check_exposures() const {
  Arena arena;
  for (size_t i = 0; i < size(); ++i) {
    const Exposure e = exposure(i);
    arena.reset();
    bsdf_of(e.material, e.beam, arena);
    check_as_rendered(e);
  }
}

Exposure InstrumentBench::exposure(size_t i) const {
  const size_t wavelength = i % wavelengths_nm_.size(), angle = i / wavelengths_nm_.size() % angles_deg_.size();
  const MeasuredMaterial& s = specimen(i);
  return {s.at(wavelength),
          {angles_deg_[angle], wavelengths_nm_[wavelength]},
          hash_key(seed_, hash_bytes(s.label())),
          as_rendered_};
}

struct InstrumentProgress::State {
  explicit State(bool quiet) : line(quiet) {}
  TerminalLine line;
  std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
};

InstrumentProgress::InstrumentProgress(size_t exposures, int64_t rays_each, bool quiet)
    : state_(std::make_unique<State>(quiet)), exposures_(exposures), rays_each_(rays_each) {}

InstrumentProgress::~InstrumentProgress() = default;

void InstrumentProgress::operator()(int64_t rays) {
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - state_->start).count();
  if (!state_->line.is_due(seconds)) return;
  state_->line.show(fmt::format("measurement {} of {}  {:.1f} of {:.1f} M rays  {:.0f} s", exposure_ + 1, exposures_,
                                double(rays) * 1e-6, double(rays_each_) * 1e-6, seconds));
}

std::vector<std::string> instrument_notes(const std::string& instrument, const InstrumentOptions& options,
                                          const InstrumentBench& bench) {
  std::vector<std::string> notes{fmt::format("frond {} {}", FROND_VERSION, instrument)};
  for (const MeasuredMaterial& s : bench.specimens()) notes.push_back("material: " + s.label());
  notes.push_back(fmt::format("seed: {}", options.seed));
  notes.push_back(options.as_rendered
                      ? "As rendered: light comes along wi and is seen along wo, whichever the model calls incident."
                      : "Light comes in along the direction that the material's model calls incident, whatever its "
                        "\"incident\" says.");
  const auto& angles = bench.angles_deg();
  if (std::find(angles.begin(), angles.end(), 90) != angles.end())
    notes.push_back(
        "At 90 degrees light meets neither side: that figure is the limit from the front, cos theta = 1e-7.");
  return notes;
}

}  // namespace frond

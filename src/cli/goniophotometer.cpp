#include "instruments/goniophotometer.h"

#include <CLI/CLI.hpp>

#include "cli/commands.h"
#include "cli/instrument.h"
#include "cli/number_list.h"
#include "report/chart.h"
#include "report/patch_charts.h"
#include "report/text_output.h"

namespace frond {
namespace {

struct GoniophotometerOptions : InstrumentOptions {
  std::string patches = "20x40", map, map_scale = "linear";
  bool integrate = false;
};

DetectorSphere sphere_of(const GoniophotometerOptions& o) {
  const auto [thetas, phis] = parse_product("--patches", o.patches);
  return {thetas, phis};
}

/// What would be refused in an hour is refused now.
void check(const GoniophotometerOptions& o, const InstrumentBench& bench, const DetectorSphere& sphere) {
  const ReadingCounts counts{bench.specimens().size(), bench.angles_deg().size(), bench.wavelengths_nm().size()};
  if (!o.plot.empty()) check_plane_chart(counts, sphere);
  if (!o.map.empty()) check_chart(o.map), check_map_chart(counts, sphere);
  for (size_t i = 0; i < bench.size(); ++i) check_no_delta_lobe(bench.exposure(i));
}

std::vector<LabelledPatches> measure(const GoniophotometerOptions& o, const InstrumentBench& bench,
                                     const DetectorSphere& sphere, int64_t rays) {
  std::vector<LabelledPatches> readings;
  InstrumentProgress progress(bench.size(), rays, o.quiet);
  for (size_t i = 0; i < bench.size(); ++i) {
    progress.start(i);
    const Exposure exposure = bench.exposure(i);
    readings.push_back(
        {bench.specimen(i).label(), o.integrate && has_exact_f(exposure)
                                        ? integrate_f(exposure, sphere, bench.pool())
                                        : measure_f(exposure, sphere, rays, bench.pool(), std::ref(progress))});
  }
  return readings;
}

void run_goniophotometer(const GoniophotometerOptions& o) {
  const int64_t rays = parse_count("--rays", o.rays.empty() ? "1e6" : o.rays, 2);
  const DetectorSphere sphere = sphere_of(o);
  const InstrumentBench bench(o);
  check(o, bench, sphere);
  const auto readings = measure(o, bench, sphere, rays);
  const auto notes = instrument_notes("goniophotometer", o, bench);
  if (!o.csv.empty()) write_text(o.csv, patches_csv(notes, readings));
  if (!o.json.empty()) write_text(o.json, patches_json(notes, readings));
  if (!o.plot.empty()) write_chart(o.plot, plane_chart(readings));
  if (!o.map.empty()) write_chart(o.map, map_chart(readings, o.map_scale == "log"));
  if (o.csv != "-" && o.json != "-" && !o.quiet) write_text("-", patches_text(readings));
}

}  // namespace

void add_goniophotometer_command(CLI::App& app) {
  auto* command = app.add_subcommand("goniophotometer", "Measure a material's BRDF and BTDF over the whole sphere.");
  auto o = std::make_shared<GoniophotometerOptions>();
  add_instrument_options(*command, *o);
  command->add_option("--rays", o->rays, "Rays for each reading; 1e6 by default.");
  command->add_option("--patches", o->patches,
                      "Detectors: THETAxPHI patches of equal angles over the whole sphere; 20x40 by default.");
  command->add_flag(
      "--integrate", o->integrate,
      "Integrate f over each patch, without noise, where it is no random estimate; shoot rays elsewhere.");
  command->add_option("--plot", o->plot, "Chart of f in the plane of incidence, .svg or .png.")->type_name("FILE");
  command->add_option("--map", o->map, "Polar maps of f over both hemispheres, .svg or .png.")->type_name("FILE");
  command->add_option("--map-scale", o->map_scale, "Colours of the map: linear (default) or log.")
      ->check(CLI::IsMember({"linear", "log"}));
  command->callback([o] { run_goniophotometer(*o); });
}

}  // namespace frond

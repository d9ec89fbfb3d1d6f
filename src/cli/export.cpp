#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "cli/commands.h"
#include "cli/common_options.h"
#include "cli/number_list.h"
#include "cli/specimen_options.h"
#include "exports/format.h"
#include "instruments/given_wavelengths.h"
#include "radiometry/radiometer_scene.h"
#include "render/measured_material.h"
#include "render/plugins.h"
#include "report/text_output.h"

namespace frond {
namespace {

struct ExportCommandOptions : SpecimenOptions {
  std::string format, output, wavelengths, angles, view_angles, view_azimuths, rays;
};

constexpr double kHorizon_deg = 90;
constexpr Interval kWavelengths_nm{360, 2500}, kAngles_deg{0, kHorizon_deg};

struct ListOption {
  const char* name;
  Interval range;
};

std::vector<double> list_of(const ListOption& option, const std::string& text, bool horizon_is_out) {
  if (text.empty()) return {};
  auto numbers = parse_numbers(option.name, text);
  for (const double x : numbers)
    if (!option.range.contains(x) || (horizon_is_out && x == option.range.max))
      fail({}, "{} go from {:g} {} {:g}, {:g} was given", option.name, option.range.min,
           horizon_is_out ? "to below" : "to", option.range.max, x);
  return numbers;
}

ExportRequest request_of(const ExportCommandOptions& o) {
  constexpr int64_t kLeastRays = 2;
  return {list_of({"--wavelengths", kWavelengths_nm}, o.wavelengths, false),
          list_of({"--angles", kAngles_deg}, o.angles, true),
          list_of({"--view-angles", kAngles_deg}, o.view_angles, true),
          list_of({"--view-azimuths", {0, 360}}, o.view_azimuths, true),
          o.rays.empty() ? 0 : parse_count("--rays", o.rays, kLeastRays)};
}

/// Options that the format does not look at.
void check_options(const ExportCommandOptions& o, const ExportFormat& format) {
  const auto refuse = [&format](const std::string& given, const char* name, ExportOption option) {
    if (given.empty() || std::ranges::count(format.options, option) > 0) return;
    std::vector<std::string_view> others;
    for (const ExportFormat* f : export_formats())
      if (std::ranges::count(f->options, option) > 0) others.push_back(f->name);
    fail({}, "{} is for --format {}", name, fmt::join(others, ", "));
  };
  refuse(o.angles, "--angles", ExportOption::angles);
  refuse(o.view_angles, "--view-angles", ExportOption::views);
  refuse(o.view_azimuths, "--view-azimuths", ExportOption::views);
  refuse(o.rays, "--rays", ExportOption::rays);
}

void run_export(const ExportCommandOptions& o) {
  const ExportFormat& format = export_format(o.format);
  check_options(o, format);
  const ExportRequest request = request_of(o);
  format.check(request);
  if (o.output == "-" && !format.is_text) fail({}, "--format {} is no text: it goes to a file", format.name);
  check_text_output(o.output);
  const ConsoleLog log(o.quiet);
  ThreadPool pool(o.threads);
  const Registry registry = load_registry(o.plugins);
  const auto cache = cache_directory(o.cache, o.no_cache);
  const auto prepare = [&](const std::vector<double>& nm) -> std::shared_ptr<const Material> {
    return ready_material(o.material, registry, GivenWavelengths({nm.begin(), nm.end()}), pool, log, cache,
                          keep_energy);
  };
  const std::string label = fmt::format("{}", fmt::join(o.material, " "));
  write_text(o.output, format.write({label, prepare, o.seed, pool, log}, request));
}

}  // namespace

void add_export_command(CLI::App& app) {
  auto* command = app.add_subcommand("export", "Write a material's BSDF as a file for other programs.");
  auto o = std::make_shared<ExportCommandOptions>();
  add_material_options(*command, *o);
  std::vector<std::string> names, docs;
  for (const ExportFormat* f : export_formats()) {
    names.emplace_back(f->name);
    docs.push_back(fmt::format("{}: {}", f->name, f->doc));
  }
  command->add_option("--format", o->format, fmt::format("What to write. {}.", fmt::join(docs, "; ")))
      ->type_name(fmt::format("TEXT:{{{}}}", fmt::join(names, ",")))
      ->required();
  command->add_option("-o,--output", o->output, "File; - for standard output, of formats that are text.")
      ->type_name("FILE")
      ->required();
  command->add_option("--wavelengths", o->wavelengths,
                      "nm, 360 to 2500: a list or a range; ascending, or red,green,blue of osl.");
  command->add_option("--angles", o->angles, "Of tables: degrees from the normal to the light, on either side.");
  command->add_option("--view-angles", o->view_angles, "Of tables: degrees from the normal to the viewer.");
  command->add_option("--view-azimuths", o->view_azimuths,
                      "Of tables: degrees from the light's azimuth to the viewer's; the mirror direction is at 180.");
  command->add_option("--rays", o->rays, "Rays for each share of the light that is measured by rays.");
  command->callback([o] { run_export(*o); });
}

}  // namespace frond

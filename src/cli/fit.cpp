#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <filesystem>

#include "cli/commands.h"
#include "cli/common_options.h"
#include "core/log.h"
#include "core/parallel.h"
#include "leaf/fit/measured_spectra.h"
#include "report/chart.h"
#include "report/fit_report.h"
#include "report/text_output.h"
#include "system/cpu_clock.h"

namespace frond {
namespace {

struct FitOptions {
  std::string file, output, json, csv, plot, structure, sieve, like, material = "leaf";
  std::vector<std::string> fixed;
  leaf::SpectraReading reading;
  int threads = 0;
  bool quiet = false;
};

/// What may be fixed: what is fitted, and what follows it.
std::vector<std::string_view> fixable() {
  std::vector<std::string_view> names{"mesophyllfraction", "chlorophyllb", "lignin"};
  for (const leaf::FitVariable& v : leaf::kFitVariables) names.push_back(v.name);
  return names;
}

leaf::FitRequest::Fixed fixed_of(const std::string& word) {
  const size_t equals = word.find('=');
  const std::string name = word.substr(0, equals);
  const auto names = fixable();
  if (std::ranges::find(names, name) == names.end()) {
    const std::string_view meant = nearest(name, names);
    fail({}, "--fix: a fit has no number \"{}\"{}", name,
         meant.empty() ? "" : fmt::format("; did you mean \"{}\"?", meant));
  }
  double value = 0;
  const char* begin = equals == word.npos ? nullptr : word.data() + equals + 1;
  const char* end = word.data() + word.size();
  if (!begin || begin == end || std::from_chars(begin, end, value).ptr != end || !(value >= 0) || !std::isfinite(value))
    fail({}, "--fix {}: {}=NUMBER is needed, 0 at least, in the scene's units", word, name);
  for (const leaf::FitVariable& v : leaf::kFitVariables)
    if (v.name == name && !(value > 0) && (v.is_structure || v.number == &leaf::TissueParams::thickness_m))
      fail({}, "--fix {}: {} is above 0", word, name);
  return {name, value};
}

const leaf::Specimen* specimen_of(const std::string& name) {
  if (name.empty()) return nullptr;
  if (const leaf::Specimen* found = leaf::find_specimen(name)) return found;
  fail({}, "--like: there is no specimen \"{}\": {}", name, fmt::join(leaf::kSpecimenNames, ", "));
}

leaf::FitRequest request_of(const FitOptions& o, const leaf::MeasuredSpectra& measured) {
  leaf::FitRequest request{.readings = measured.readings};
  request.like = specimen_of(o.like);
  request.has_prior = request.like != nullptr;
  if (request.like) request.structure = request.like->params.structure;
  if (!o.structure.empty()) {
    const auto structure = o.structure == "bifacial" ? leaf::Structure::bifacial : leaf::Structure::unifacial;
    if (request.structure && *request.structure != structure)
      fail({}, "--like {} is {}, --structure says otherwise", o.like,
           *request.structure == leaf::Structure::bifacial ? "bifacial" : "unifacial");
    request.structure = structure;
  }
  if (!o.sieve.empty()) request.sieve = o.sieve == "on";
  for (const std::string& word : o.fixed) request.fixed.push_back(fixed_of(word));
  size_t values = 0;
  for (const leaf::LeafReading& r : request.readings) values += (r.r ? 1 : 0) + (r.t ? 1 : 0);
  const size_t free = std::size(leaf::kFitVariables) - std::min(std::size(leaf::kFitVariables), request.fixed.size());
  if (values < free && !request.has_prior)
    fail({}, "{} values are fewer than the {} numbers to fit: --fix some, or --like a specimen", values, free);
  if (values == 0) fail({}, "there is no value to fit within 360 to 2500 nm in {}", o.file);
  return request;
}

void run_fit(const FitOptions& o) {
  for (const std::string& path : {o.output, o.json, o.csv})
    if (!path.empty()) check_text_output(path);
  if (!o.plot.empty()) check_chart(o.plot);
  const ConsoleLog log(o.quiet);
  const leaf::MeasuredSpectra measured = leaf::read_measured_spectra(o.file, o.reading);
  if (measured.is_in_percent) log.info("values are in percent");
  if (measured.left_out > 0)
    log.warn({}, fmt::format("{} rows are left out: beyond 360 to 2500 nm, or without a number", measured.left_out));
  const leaf::FitRequest request = request_of(o, measured);
  const double start = cpu_seconds();
  const leaf::FitResult result = leaf::fit_leaf(request, ThreadPool(o.threads));
  log.info(fmt::format("fitted in {:.2g} s of CPU", cpu_seconds() - start));
  std::string source = std::filesystem::path(o.file).filename().string();
  if (!o.reading.leaf.empty()) source += ", " + o.reading.leaf;
  const FitReport report{request, result, source, o.material};
  if (!o.output.empty()) write_text(o.output, fit_scene(report));
  if (!o.json.empty()) write_text(o.json, fit_json(report));
  if (!o.csv.empty()) write_text(o.csv, fit_csv(report));
  if (!o.plot.empty()) write_chart(o.plot, fit_chart(report));
  if (!o.quiet && o.json != "-" && o.csv != "-" && o.output != "-") write_text("-", fit_text(report));
}

}  // namespace

void add_fit_command(CLI::App& app) {
  auto* command = app.add_subcommand("fit", "Make a leaf of measured reflectance and transmittance.");
  auto o = std::make_shared<FitOptions>();
  command->add_option("file", o->file, "Measured spectra: CSV as frond spectrophotometer and spectroradiometers write.")
      ->type_name("FILE")
      ->required();
  command->add_option("-o,--output", o->output, "Scene file with the leaf's Material line; -: standard output.")
      ->type_name("FILE");
  command->add_option("--json", o->json, "All that was found: numbers, errors, correlations, spectra.")
      ->type_name("FILE");
  command->add_option("--csv", o->csv, "Measured and fitted spectra.")->type_name("FILE");
  command->add_option("--plot", o->plot, "Chart of measured and fitted, .svg or .png.")->type_name("FILE");
  command->add_option("--leaf", o->reading.leaf, "Of a file with several leaves, the one to fit.");
  command->add_option("--angle", o->reading.theta_deg, "Of incidence, where the file does not say it: 8 degrees.")
      ->check(CLI::Range(0.0, 180.0));
  command->add_option("--structure", o->structure, "bifacial or unifacial; by default what fits better.")
      ->check(CLI::IsMember({"bifacial", "unifacial"}));
  command->add_option("--sieve", o->sieve, "on or off: absorption with sieve and detour; by default what fits better.")
      ->check(CLI::IsMember({"on", "off"}));
  command->add_option("--fix", o->fixed,
                      "NAME=NUMBER: a number that is known, in the scene's units. May be given again.");
  command
      ->add_option("--like", o->like,
                   "A specimen that the leaf is like: its numbers are expected within a third or so.")
      ->type_name("SPECIMEN");
  command->add_option("--material", o->material, "That the leaf is written down for: leaf by default.")
      ->check(CLI::IsMember({"leaf", "leaf_solved", "leaf_simplified", "leaf_lambert", "abm"}));
  command->add_option("--threads", o->threads, "Threads; all by default. The leaf does not depend on it.")
      ->check(CLI::NonNegativeNumber);
  command->add_flag("-q,--quiet", o->quiet, "Say nothing but what is wrong.");
  command->callback([o] { run_fit(*o); });
}

}  // namespace frond

#include "leaf/fit/fit.h"

#include <algorithm>
#include <cmath>

#include "jobs/record/common_params.h"
#include "leaf/fit/measured_spectra.h"
#include "report/chart.h"
#include "report/fit_report.h"
#include "report/text_output.h"
#include "scene/format/tokenizer.h"
#include "system/machine.h"

namespace frond {

// `frond fit`: leaf parameters from measured reflectance and transmittance (docs/fit.md).

namespace {

using enum ArgumentKind;

constexpr std::string_view kStructures[] = {"bifacial", "unifacial"}, kSieve[] = {"on", "off"},
                           kMaterials[] = {"leaf", "leaf_solved", "leaf_simplified", "leaf_lambert", "abm"};

constexpr JobParam kParams[] = {
    JobParam("file", text, "Measured spectra: CSV as written by frond spectrophotometer or by spectroradiometers.",
             {.type = "FILE", .path = PathUse::read, .decides = true, .positional = true, .excludes = "data"}),
    JobParam("data", text, "Measured spectra as a string, in the format of such a file.",
             {.type = "CSV", .decides = true}),
    JobParam("output", text, "Scene file to write, with the leaf's Material directive; - is standard output.",
             {.type = "FILE", .aliases = "o", .path = PathUse::write}),
    kJsonParam,
    kCsvParam,
    chart_param("plot", "Chart of measured and fitted spectra: .svg or .png."),
    JobParam("leaf", text, "Name of the leaf to fit, if the file has several.", {.type = "LEAF", .decides = true}),
    JobParam("angle", real, "Angle of incidence, if the file does not state it.",
             {.default_value = "8", .unit = "degrees", .range = {0, 180}, .decides = true}),
    JobParam("structure", text, "Structure of the leaf; by default the better fit.",
             {.choices = kStructures, .decides = true}),
    JobParam("sieve", text, "Absorption with sieve and detour effects; by default the better fit.",
             {.choices = kSieve, .decides = true}),
    JobParam("fix", texts, "NAME=NUMBER: keep a parameter at this value, in the units of scene files.",
             {.type = "NAME=NUMBER", .decides = true}),
    JobParam("like", text, "Specimen used as a prior (standard deviation about one third).",
             {.choices = leaf::kSpecimenNames, .decides = true}),
    JobParam("material", text, "Material type to write.",
             {.default_value = "leaf", .choices = kMaterials, .decides = true}),
};

/// Parses NAME=NUMBER for a fitted parameter, or for one that depends on a fitted parameter. Throws InputError.
leaf::FitRequest::Fixed fixed_of(const std::string& word, const std::string& option) {
  std::vector<std::string_view> names{"mesophyllfraction", "chlorophyllb", "lignin"};
  for (const leaf::FitVariable& v : leaf::kFitVariables) names.push_back(v.name);
  const size_t equals = word.find('=');
  const std::string name = word.substr(0, equals);
  if (std::ranges::find(names, name) == names.end())
    fail({}, "{}: there is no fit parameter \"{}\"{}", option, name, suggestion(name, names));
  const auto value = equals == word.npos ? std::nullopt : parse_number(word.substr(equals + 1));
  if (!value || !(*value >= 0) || !std::isfinite(*value))
    fail({}, "{} {}: {}=NUMBER is needed, 0 at least, in the scene's units", option, word, name);
  for (const leaf::FitVariable& v : leaf::kFitVariables)
    if (v.name == name && !(*value > 0) && (v.is_structure || v.number == &leaf::TissueParams::thickness_m))
      fail({}, "{} {}: {} is above 0", option, word, name);
  return {name, *value};
}

/// Returns the structure of --structure or --like; nullopt: fit both and select the better one. Throws InputError if
/// they contradict each other.
std::optional<leaf::Structure> structure_of(const Arguments& args, const leaf::Specimen* like) {
  using enum leaf::Structure;
  const std::string given = args.text("structure");
  if (!like) return given.empty() ? std::nullopt : std::optional(given == "bifacial" ? bifacial : unifacial);
  const std::string_view own = like->params.structure == bifacial ? "bifacial" : "unifacial";
  if (!given.empty() && given != own)
    fail({}, "{} {} is {}, which contradicts {}", args.spelled("like"), like->name, own, args.spelled("structure"));
  return like->params.structure;
}

/// Builds the request. Throws InputError if there are fewer values than free parameters and no prior.
leaf::FitRequest request_of(const Arguments& args, std::vector<leaf::LeafMeasurement> measurements) {
  leaf::FitRequest request{.measurements = std::move(measurements)};
  request.like = leaf::find_specimen(args.text("like"));
  request.has_prior = request.like != nullptr;
  request.structure = structure_of(args, request.like);
  if (args.given("sieve")) request.sieve = args.text("sieve") == "on";
  for (const std::string& word : args.texts("fix")) request.fixed.push_back(fixed_of(word, args.spelled("fix")));
  size_t values = 0;
  for (const leaf::LeafMeasurement& r : request.measurements) values += (r.r ? 1 : 0) + (r.t ? 1 : 0);
  // Fewer values than parameters leave the fit undetermined, unless a prior determines the rest.
  const size_t all = std::size(leaf::kFitVariables), free = all - std::min(all, request.fixed.size());
  const Location where =
      args.given("file") ? Location{std::make_shared<const std::string>(args.text("file")), 0, 0} : Location{};
  if (values == 0) fail(where, "there is no value to fit within 360 to 2500 nm");
  if (values < free && !request.has_prior)
    fail(where, "{} values are fewer than the {} parameters to fit: use {} or {}", values, free, args.spelled("fix"),
         args.spelled("like"));
  return request;
}

/// Throws InputError for a value that the material would refuse.
void check_fixed(const std::vector<leaf::FitRequest::Fixed>& fixed, const MaterialInfo& material,
                 const std::string& option) {
  for (const auto& [name, value] : fixed)
    if (const Param* p = find_param(material, name); p && !p->range.contains(value))
      fail({}, "{} {}: {:g} is outside its range {:g} to {:g} {}", option, name, value, p->range.min, p->range.max,
           p->unit);
}

/// Reads the measurements of --file or --data. Rows outside 360 to 2500 nm are left out with a warning.
std::vector<leaf::LeafMeasurement> measurements_of(const JobRun& run) {
  const Arguments& args = run.args;
  if (!args.given("file") && !args.given("data"))
    fail({}, "measured spectra are needed: a file, or {}", args.spelled("data"));
  const leaf::SpectraMeasurement how{args.text("leaf"), args.real("angle"), args.spelled("leaf")};
  leaf::MeasuredSpectra measured = args.given("file")
                                       ? leaf::read_measured_spectra(args.text("file"), how)
                                       : leaf::parse_measured_spectra(args.text("data"), args.spelled("data"), how);
  // A warning, because it changes the numbers: -q shows it too.
  if (!measured.in_percent.empty())
    run.log().warn({}, fmt::format("the values of {} are in percent: they are divided by 100", measured.in_percent));
  if (measured.left_out > 0)
    run.log().warn({},
                   fmt::format("{} rows are left out: beyond 360 to 2500 nm, or without a number", measured.left_out));
  return std::move(measured.measurements);
}

/// The job: fits the leaf, and writes scene file, chart and tables.
Result fit(const JobRun& run) {
  const StopScope stop(run.control.stop);
  const Arguments& args = run.args;
  check_chart_param(run, "plot");
  const leaf::FitRequest request = request_of(args, measurements_of(run));
  check_fixed(request.fixed, run.session().registry().materials.get(args.text("material"), {}), args.spelled("fix"));
  const double start = cpu_seconds();
  const leaf::FitResult fitted = leaf::fit_leaf(request, run.session().pool());
  run.log().info(fmt::format("fitted in {:.2g} s of CPU", cpu_seconds() - start));
  std::string source = args.given("file") ? std::filesystem::path(args.text("file")).filename().string() : "data";
  if (args.given("leaf")) source += ", " + args.text("leaf");
  const FitReport report{request, fitted, source, args.text("material")};
  if (args.given("output")) write_text(args.text("output"), fit_scene(report));
  if (args.given("plot")) write_chart(args.text("plot"), fit_chart(report));
  auto facts = fit_facts(report);
  facts.push_back({"scene", fit_scene(report)});
  return {.tables = fit_tables(report),
          .facts = std::move(facts),
          .notes = {fmt::format("{}, fitted by frond fit: RMSE {:.4f}", source, fitted.rmse)},
          .text = fit_text(report)};
}

}  // namespace

extern const JobInfo kFitJob("fit", "Leaf models", "Fit a leaf to measured reflectance and transmittance.", "", kParams,
                             SessionUse::threads, fit);

}  // namespace frond

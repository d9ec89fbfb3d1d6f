#include "leaf/fit/fit.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <map>
#include <mutex>

#include "core/messages/counted.h"
#include "core/units/number.h"
#include "jobs/record/common_params.h"
#include "jobs/support/fit_directions.h"
#include "jobs/support/fit_request.h"
#include "leaf/fit/measured_spectra.h"
#include "materials/leaf_params.h"
#include "report/chart.h"
#include "report/fit_report.h"
#include "report/text_output.h"
#include "scene/leaf_models.h"
#include "system/machine.h"

namespace frond {

// `frond fit`: leaf parameters from measured reflectance and transmittance (docs/fit.md).

namespace {

using enum ArgumentKind;

constexpr std::string_view kStructures[] = {"bifacial", "unifacial"}, kSieve[] = {"on", "off"},
                           kAbsorption[] = {"prospect", "baranoski"};

constexpr JobParam kFitParams[] = {
    JobParam("file", texts,
             "Measured spectra: CSV as written by frond spectrophotometer or by spectroradiometers. Of several files, "
             "all leaves are fitted.",
             {.type = "FILE", .path = PathUse::read, .decides = true, .positional = true, .excludes = "data"}),
    JobParam("data", text, "Measured spectra as a string, in the format of such a file.",
             {.type = "CSV", .decides = true}),
    JobParam("output", text,
             "Scene file to write, with the leaf's Material directive, or a MakeNamedMaterial directive for each of "
             "all leaves; - is standard output.",
             {.type = "FILE", .aliases = "o", .path = PathUse::write}),
    kJsonParam,
    kCsvParam,
    chart_param("plot", "Chart of measured and fitted spectra: .svg or .png."),
    JobParam("leaf", text, "Name of the leaf to fit, if the file has several.",
             {.type = "LEAF", .decides = true, .excludes = "all-leaves"}),
    JobParam("all-leaves", flag,
             "Fit every leaf; --csv has one row for each, with its parameters, their standard errors and, if it could "
             "not be fitted, the reason.",
             {.decides = true}),
    JobParam("specimens", text,
             "Specimen file to write: the fitted leaves, and \"mean\", the leaf fitted to the means of their R and T "
             "(docs/fit.md).",
             {.type = "FILE", .path = PathUse::write}),
    JobParam("directions", text,
             "Goniometer table of the leaf, as frond goniophotometer writes it: report the differences by direction "
             "between it and the fitted leaf.",
             {.type = "FILE", .path = PathUse::read, .decides = true, .excludes = "all-leaves"}),
    JobParam("angle", real, "Angle of incidence, if the file does not state it.",
             {.default_value = "8",
              .unit = "degrees",
              .range = {0, 180},
              .decides = true,
              .quantity = PhysicalQuantity::angle}),
    JobParam("background", real,
             "Reflectance of what lies behind the leaf while R is measured, such as the white or black pad of a leaf "
             "clip; 0: nothing, as in an integrating sphere.",
             {.default_value = "0", .range = {0, 0.999}, .decides = true}),
    JobParam("structure", text, "Structure of the leaf; by default the better fit.",
             {.choices = kStructures, .decides = true}),
    JobParam("sieve", text, "Absorption with sieve and detour effects; by default the better fit.",
             {.choices = kSieve, .decides = true}),
    JobParam(
        "absorption", text,
        "Specific absorption of the leaf: PROSPECT-D's, with dry matter and anthocyanins, or the published model's "
        "(baranoski), with protein and cellulose. By default that of --like, or else prospect.",
        {.choices = kAbsorption, .decides = true}),
    JobParam(
        "fix", texts,
        "NAME=NUMBER[UNIT]: keep a parameter at this value, in the units of scene files, or a content per leaf area "
        "in ug/cm2, mg/cm2 or g/cm2 (chlorophyll=40ug/cm2, water=0.012g/cm2).",
        {.type = "NAME=NUMBER", .decides = true}),
    JobParam("like", text, "Specimen used as a prior (standard deviation about one third).",
             {.choices = leaf::kSpecimenNames, .decides = true}),
    JobParam("prior", texts,
             "Measured spectra of three or more leaves, with R and T: for a leaf of which R alone or T alone was "
             "measured, a prior over its structure is learned from them. By default that of seven leaves.",
             {.type = "FILE", .path = PathUse::read, .decides = true, .excludes = "like"}),
    JobParam("material", text, "Leaf material to write.",
             {.type = "MATERIAL", .default_value = "leaf", .decides = true}),
};

/// Returns the record of --material. Throws InputError if it is no leaf, or one without a leaf's parameters.
const MaterialInfo& material_of(const JobRun& run) {
  const std::string option = run.args.spelled("material"), name = run.args.text("material");
  const Registry& registry = run.session().registry();
  const MaterialInfo& material = registry.materials.get(name, {std::make_shared<const std::string>(option)});
  if (!material.leaf) {
    std::vector<std::string_view> leaves{open_leaf(registry).name};
    for (const MaterialInfo* model : leaf_models(registry)) leaves.push_back(model->name);
    fail({}, "{}: \"{}\" is no leaf; leaves are {}", option, name, fmt::join(leaves, ", "));
  }
  for (const Param& p : leaf_params())
    if (!find_param(material, p.name))
      fail({}, "{}: \"{}\" has no parameter \"{}\", which a fitted leaf needs", option, name, p.name);
  return material;
}

/// Throws InputError for a value that the material would refuse; warns of one that is probably in another unit.
void check_fixed(const std::vector<leaf::FitRequest::Fixed>& fixed, const MaterialInfo& material, const JobRun& run) {
  const std::string option = run.args.spelled("fix");
  for (const auto& [name, value, per_area] : fixed) {
    const Param* p = find_param(material, name);
    if (!p || per_area) continue;
    const std::string hint = unit_hint(value, p->quantity, p->unit, p->range);
    if (!p->range.contains(value))
      fail({}, "{} {}: {:g} is outside its range {:g} to {:g} {}{}{}", option, name, value, p->range.min, p->range.max,
           p->unit, hint.empty() ? "" : "; ", hint);
    if (!hint.empty()) run.log().warn({}, fmt::format("{} {}: {:g} {}: {}", option, name, value, p->unit, hint));
  }
}

/// Throws InputError if contents per area that were given lead to a leaf that the material would refuse.
void check_fitted(const leaf::TissueParams& fitted, const MaterialInfo& material, const std::string& option) {
  // A concentration that is given per area depends on the fitted thickness.
  for (const leaf::LeafNumber& n : leaf::leaf_parameters()) {
    const Param* p = find_param(material, n.name);
    if (p && !p->range.contains(n.value(fitted)))
      fail({}, "{}: the contents per area need {} {:g}, outside its range {:g} to {:g} {}", option, n.name,
           n.value(fitted), p->range.min, p->range.max, p->unit);
  }
}

/// A file as a whole.
Location location_of(const std::string& file) { return {std::make_shared<const std::string>(file), 0, 0}; }

/// Warns of values that the reader has changed. This affects the results, so -q shows it too. `name`: of the leaf, or
/// empty.
void warn_of_changes(const JobRun& run, const leaf::MeasuredSpectra& measured, const std::string& name) {
  const std::string of = name.empty() ? "" : name + ": ";
  if (measured.derived)
    run.log().info(fmt::format("{}{} = 1 - {} - A: it follows from the column of absorptances", of, measured.derived,
                               measured.derived == 'T' ? 'R' : 'T'));
  if (!measured.layout.empty()) run.log().info(fmt::format("{}read as {}", of, measured.layout));
  if (!measured.unused.empty())
    run.log().info(fmt::format("{}columns that are not used: {}", of, fmt::join(measured.unused, ", ")));
  if (!measured.in_percent.empty())
    run.log().warn({},
                   fmt::format("{}the values of {} are in percent: they are divided by 100", of, measured.in_percent));
  if (measured.left_out > 0)
    run.log().warn({}, fmt::format("{}{} left out: beyond 360 to 2500 nm, or without a number", of,
                                   counted(measured.left_out, "row is", "rows are")));
}

/// Options of the reader, with the names that its messages use.
leaf::SpectraMeasurement reader_of(const Arguments& args) {
  return {args.text("leaf"), args.real("angle"), args.spelled("leaf"), args.spelled("all-leaves")};
}

/// Returns the prior of --prior; nullopt: not given. Throws InputError for leaves that cannot be learned from: all of
/// them count, so that no leaf is left out silently.
std::optional<leaf::StructurePrior> prior_of(const JobRun& run) {
  const std::string option = run.args.spelled("prior");
  if (!run.args.given("prior")) return {};
  std::vector<leaf::FitRequest> leaves;
  std::vector<std::string> names;
  for (const std::string& file : run.args.texts("prior")) {
    names.push_back(std::filesystem::path(file).filename().string());
    for (leaf::MeasuredLeaf& one : leaf::read_measured_leaves(file, reader_of(run.args))) {
      const std::string name = one.name.empty() ? "the leaf" : one.name;
      if (!one.error.empty()) fail(location_of(file), "{}: {}: {}", option, name, one.error);
      leaves.emplace_back().measurements = std::move(one.spectra.measurements);
      if (leaf::used_prior(leaves.back()))
        fail(location_of(file), "{}: {} has R alone or T alone, from which no structure can be learned", option, name);
      check_values(run.args, leaves.back(), location_of(file));
    }
  }
  // A variance of two leaves is hardly one.
  constexpr size_t kLeast = 3;
  if (leaves.size() < kLeast) fail({}, "{}: at least {} leaves are needed, not {}", option, kLeast, leaves.size());
  return leaf::learn_prior(leaves, fmt::format("{} leaves of {}", leaves.size(), fmt::join(names, ", ")));
}

/// Warns if --prior was given for leaves that do not use it. That is no error: of many leaves some may have R and T.
void check_prior_use(const JobRun& run, const std::vector<const leaf::FitResult*>& fits) {
  if (run.args.given("prior") && std::ranges::none_of(fits, [](const auto* f) { return f->prior != nullptr; }))
    run.log().warn({}, fmt::format("{} has no effect: it is for leaves of which only R or only T was measured, with "
                                   "PROSPECT's absorption, as bifacial leaves with the sieve effect",
                                   run.args.spelled("prior")));
}

/// Fits one leaf of --file or --data.
Result fit_one(const JobRun& run) {
  const Arguments& args = run.args;
  const std::string file = args.given("file") ? args.texts("file")[0] : "";
  leaf::MeasuredSpectra measured =
      args.given("file") ? leaf::read_measured_spectra(file, reader_of(args))
                         : leaf::parse_measured_spectra(args.text("data"), args.spelled("data"), reader_of(args));
  warn_of_changes(run, measured, "");
  leaf::FitRequest request = fit_request(args);
  request.measurements = std::move(measured.measurements);
  check_values(args, request, file.empty() ? Location{} : location_of(file));
  const MaterialInfo& material = material_of(run);
  check_fixed(request.fixed, material, run);
  const std::optional<leaf::StructurePrior> prior = prior_of(run);
  if (prior) request.structure_prior = &*prior;
  const double start = cpu_seconds();
  const leaf::FitResult fitted = leaf::fit_leaf(request, run.session().pool());
  check_fitted(fitted.params, material, args.spelled("fix"));
  check_prior_use(run, {&fitted});
  run.log().info(fmt::format("fitted in {:.2g} s of CPU", cpu_seconds() - start));
  std::string source = file.empty() ? "data" : std::filesystem::path(file).filename().string();
  if (args.given("leaf")) source += ", " + args.text("leaf");
  const FitReport report{request, fitted, source, args.text("material"),
                         leaf::fit_plates(request.measurements, request.background)};
  if (args.given("output")) write_text(args.text("output"), fit_scene(report));
  if (args.given("plot")) write_chart(args.text("plot"), fit_chart(report));
  auto facts = fit_facts(report);
  facts.push_back({"scene", fit_scene(report)});
  std::vector<Table> tables = fit_tables(report);
  std::string text = fit_text(report);
  if (args.given("directions")) {
    tables.push_back(
        compare_directions(run, args.text("directions"),
                           fitted_material_text(report, std::string(noiseless_model(run.session().registry()).name))));
    text += directions_text(tables.back());
  }
  return {.tables = std::move(tables),
          .facts = std::move(facts),
          .notes = {fmt::format("{}, fitted by frond fit: RMSE {:.4f}", source, fitted.rmse)},
          .text = std::move(text)};
}

/// Appends the leaves of one file, or of --data if `file` is empty, with their measurements or errors. If
/// `keeps_errors`, an error of the file as a whole is recorded as the error of a leaf with the file's name.
void read_leaves(const JobRun& run, const std::string& file, bool keeps_errors, std::vector<LeafFitReport>& leaves) {
  const std::filesystem::path path(file);
  const std::string name = path.filename().string(), stem = file.empty() ? "data" : path.stem().string();
  std::vector<leaf::MeasuredLeaf> read;
  try {
    read = file.empty()
               ? leaf::parse_measured_leaves(run.args.text("data"), run.args.spelled("data"), reader_of(run.args))
               : leaf::read_measured_leaves(path, reader_of(run.args));
  } catch (const InputError& e) {
    if (!keeps_errors) throw;
    leaves.push_back({name, stem, e.what()});
    return;
  }
  // Warnings are reported for the file and not for each leaf: a thousand lines would hide other messages.
  leaf::MeasuredSpectra changes;
  for (leaf::MeasuredLeaf& one : read) {
    if (changes.in_percent.empty()) changes.in_percent = one.spectra.in_percent;
    changes.left_out += one.spectra.left_out;
    changes.derived = std::max(changes.derived, one.spectra.derived);
    changes.unused = one.spectra.unused;
    changes.layout = one.spectra.layout;
    LeafFitReport& leaf = leaves.emplace_back(LeafFitReport{name, one.name.empty() ? stem : one.name, one.error});
    leaf.measurements = one.spectra.measurements.size();
    leaf.request.measurements = std::move(one.spectra.measurements);
  }
  warn_of_changes(run, changes, name);
}

/// Fits one of many leaves. Sets the report's result or its error.
void fit_one_of_many(const Arguments& args, const MaterialInfo& material, leaf::FitRequest request,
                     leaf::FitCache& cache, LeafFitReport& leaf) {
  try {
    request.measurements = std::move(leaf.request.measurements);
    check_values(args, request, {});
    leaf.result = leaf::fit_leaf(request, ThreadPool(1), &cache);
    check_fitted(leaf.result.params, material, args.spelled("fix"));
    if (!std::isfinite(leaf.result.rmse)) fail({}, "the search found no leaf");
    leaf.plates = leaf::fit_plates(request.measurements, request.background);
  } catch (const InputError& e) {
    leaf.error = e.what();
  }
  // The table does not need the spectra, which would take a hundred megabytes for a thousand leaves.
  request.measurements.clear(), leaf.result.fitted.clear();
  leaf.request = std::move(request);
}

/// Returns the mean of the leaves: a leaf with the means of R and T at the wavelengths and angles that all of them
/// have. Its parameters are fitted to these, as those of every leaf: means of the leaves' parameters would be those of
/// a leaf with other R and T.
LeafFitReport mean_leaf(const std::vector<LeafFitReport>& leaves) {
  using Mean = std::array<std::pair<double, size_t>, 2>;  // sums of R and T, and their numbers of values
  std::map<std::pair<double, double>, Mean> means;
  size_t count = 0;
  for (const LeafFitReport& leaf : leaves) {
    // A leaf that could not be read has no spectra, and is not one of the library.
    if (!leaf.error.empty()) continue;
    ++count;
    for (const leaf::LeafMeasurement& m : leaf.request.measurements) {
      Mean& mean = means[{m.theta_deg, m.lambda_nm}];
      if (m.r) mean[0].first += *m.r, ++mean[0].second;
      if (m.t) mean[1].first += *m.t, ++mean[1].second;
    }
  }
  LeafFitReport report{"", "mean"};
  for (const auto& [at, mean] : means) {
    const auto value = [&](const auto& sum) {
      return sum.second == count ? std::optional(sum.first / double(count)) : std::nullopt;
    };
    const leaf::LeafMeasurement m{at.second, at.first, value(mean[0]), value(mean[1])};
    if (m.r || m.t) report.request.measurements.push_back(m);
  }
  return report;
}

/// Fits every leaf of the files, each on one thread: the result does not depend on their number.
Result fit_all(const JobRun& run) {
  const Arguments& args = run.args;
  if (args.given("plot")) fail({}, "{} draws one leaf: {} selects it", args.spelled("plot"), args.spelled("leaf"));
  // Errors in the options end the job before any file is read; errors of one leaf do not.
  leaf::FitRequest request = fit_request(args);
  const std::optional<leaf::StructurePrior> prior = prior_of(run);
  if (prior) request.structure_prior = &*prior;
  const MaterialInfo& material = material_of(run);
  check_fixed(request.fixed, material, run);
  const std::vector<std::string> files = args.given("file") ? args.texts("file") : std::vector<std::string>{""};
  std::vector<LeafFitReport> leaves;
  for (const std::string& file : files) read_leaves(run, file, files.size() > 1, leaves);

  LeafFitReport mean = mean_leaf(leaves);  // before the fits, which drop the spectra

  const auto start = std::chrono::steady_clock::now();
  const double cpu = cpu_seconds();
  leaf::FitCache cache;
  std::mutex mutex;
  size_t done = 0;
  run.session().pool().for_each(static_cast<int64_t>(leaves.size()), [&](int64_t i, int) {
    LeafFitReport& leaf = leaves[static_cast<size_t>(i)];
    if (leaf.error.empty()) fit_one_of_many(args, material, request, cache, leaf);
    const std::lock_guard lock(mutex);
    RenderStatistics so_far;
    so_far.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    so_far.cpu_seconds = cpu_seconds() - cpu;
    if (run.control.progress) run.control.progress->update(double(++done) / double(leaves.size()), so_far);
  });
  if (run.control.progress) run.control.progress->finish();
  std::vector<const leaf::FitResult*> fits;
  for (const LeafFitReport& leaf : leaves)
    if (leaf.error.empty()) fits.push_back(&leaf.result);
  check_prior_use(run, fits);
  // A table without any leaf would look like a success.
  if (std::ranges::none_of(leaves, [](const LeafFitReport& leaf) { return leaf.error.empty(); }))
    fail({}, "no leaf could be fitted; the first, {}: {}", leaves[0].leaf, leaves[0].error);
  run.log().info(fmt::format("fitted in {:.3g} s of CPU", cpu_seconds() - cpu));
  if (args.given("output")) write_text(args.text("output"), leaves_scene(leaves, args.text("material")));
  if (args.given("specimens")) {
    fit_one_of_many(args, material, request, cache, mean);
    if (!mean.error.empty())
      run.log().warn({}, fmt::format("{}: no mean leaf: {}", args.spelled("specimens"), mean.error));
    write_text(args.text("specimens"), specimens_csv(leaves, mean, request.absorption_tables));
  }
  return {.tables = {leaves_table(leaves, request.absorption_tables)},
          .facts = leaves_facts(leaves),
          .notes = {"leaves fitted by frond fit"},
          .text = leaves_text(leaves)};
}

/// The job: fits the leaf, and writes scene file, chart and tables.
Result fit(const JobRun& run) {
  const Arguments& args = run.args;
  check_chart_param(run, "plot");
  warn_if_nothing_is_kept(run);
  if (!args.given("file") && !args.given("data"))
    fail({}, "measured spectra are needed: a file, or {}", args.spelled("data"));
  // Several files imply --all-leaves, because no single leaf can be meant.
  const bool has_files = args.given("file") && args.texts("file").size() > 1;
  if (has_files && args.given("directions"))
    fail({}, "{} compares one leaf, but there are {} files", args.spelled("directions"), args.texts("file").size());
  if (args.given("specimens") && !args.flag("all-leaves") && !has_files)
    fail({}, "{} writes many leaves: add {}", args.spelled("specimens"), args.spelled("all-leaves"));
  if (has_files && args.given("leaf"))
    fail({}, "{} selects a leaf of one file, but there are {}", args.spelled("leaf"), args.texts("file").size());
  return args.flag("all-leaves") || has_files ? fit_all(run) : fit_one(run);
}

}  // namespace

extern const JobInfo kFitJob("fit", "Leaf models", "Fit a leaf to measured reflectance and transmittance.", "",
                             kFitParams, SessionUse::threads, fit);

}  // namespace frond

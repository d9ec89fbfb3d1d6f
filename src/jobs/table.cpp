#include "leaf/table/table.h"

#include <algorithm>
#include <map>

#include "core/messages/counted.h"
#include "jobs/leaf/leaf_text.h"
#include "jobs/record/common_params.h"
#include "leaf/plates/plate_leaf.h"
#include "leaf/table/mode_lookup.h"
#include "leaf/table/mode_table_cache.h"
#include "leaf/table/mode_table_file.h"
#include "leaf/table/table_cache.h"
#include "leaf/table/table_file.h"
#include "leaf/tissue/constants.h"
#include "materials/leaf_file.h"
#include "materials/leaf_params.h"
#include "report/text_output.h"
#include "scene/format/plugin_text.h"
#include "scene/leaf_models.h"
#include "system/machine.h"

namespace frond {

// `frond table`: tables of leaf models as files (docs/file_formats.md).

namespace {

using enum ArgumentKind;

constexpr std::string_view kMethods[] = {"solve", "montecarlo"};

constexpr JobParam kTableParams[] = {
    JobParam("leaf", texts,
             "MATERIAL,parameter=value,...: a leaf model that looks up a table, with the leaf's parameters; without a "
             "name the one with a table of R and T, for FILE.leaf the one with a mode table.",
             {.type = "MATERIAL", .decides = true, .positional = true}),
    JobParam("specimen", text, "Specimen of the leaf; soybean by default.",
             {.choices = leaf::kSpecimenNames, .decides = true}),
    JobParam("method", text, "Method: solve (deterministic, without noise) or montecarlo (random walks, as published).",
             {.default_value = "solve", .choices = kMethods, .decides = true}),
    JobParam(
        "wavelengths", numbers, "Wavelengths.",
        {.unit = "nm", .range = leaf::kConstantsRange_nm, .aliases = "wavelength", .decides = true, .required = true}),
    JobParam("angles", numbers, "Angles of incidence, ascending; above 90 on the abaxial side.",
             {.default_value = "0:180:1", .unit = "degrees", .range = {0, 180}, .decides = true}),
    JobParam("rays", count, "Number of random walks for each angle and wavelength, with montecarlo.",
             {.default_value = "1e6", .range = {1, 1e9}, .decides = true}),
    JobParam("nodes", count,
             "Number of quadrature nodes for each segment of directions; by default chosen by its error.",
             {.range = {2, 200}, .decides = true}),
    JobParam("depths", numbers, "Range of optical depths in a .leaf file, for leaves whose chemistry varies.",
             {.type = "LEAST,MOST", .range = {0, kAnyValue.max}, .values = 2, .decides = true}),
    kSeedParam,
    JobParam("equalsides", flag, "Write the mean of both sides, at angles up to 90 degrees.", {.decides = true}),
    JobParam(
        "output", text,
        "File to write; - is standard output. FILE.leaf, of a mode table: for other programs (docs/file_formats.md).",
        {.type = "FILE", .aliases = "o", .path = PathUse::write, .required = true}),
};

/// Throws InputError for parameters that control the table of a render; the message names this job's equivalent.
void check_is_of_leaf(const std::string& name, const Arguments& args) {
  const std::map<std::string, std::string> instead{{"tablemethod", args.spelled("method") + " solve or montecarlo"},
                                                   {"tablerays", args.spelled("rays")},
                                                   {"tablestep", args.spelled("angles") + " first:last:step"}};
  if (name == "tablefile") fail({}, "a table is made of a leaf, not of a \"tablefile\"");
  if (const auto found = instead.find(name); found != instead.end())
    fail({}, "\"{}\" applies to renders, which compute their own table: use {}", name, found->second);
}

/// Leaf model of a table, and the leaf's parameters as text.
struct TableLeaf {
  const MaterialInfo& model;
  PluginText text;

  bool has_modes() const { return model.leaf->table == LeafModel::Table::modes; }
};

/// Parses the positional words: a material and its parameters. Throws InputError.
TableLeaf leaf_of(const JobRun& run) {
  const Registry& registry = run.session().registry();
  const MaterialInfo &with_shares = model_with(LeafModel::Table::shares, registry),
                     &with_modes = model_with(LeafModel::Table::modes, registry);
  std::string text = material_text(run.args.texts("leaf"));
  const size_t end = text.find(',');
  const bool is_leaf_file = run.args.text("output").ends_with(".leaf");
  if (text.empty() || text.substr(0, end).find('=') != std::string::npos)
    text = std::string((is_leaf_file ? with_modes : with_shares).name) + (text.empty() ? "" : ",") + text;
  PluginText leaf = parse_plugin_text(text, {});
  const MaterialInfo* model = registry.materials.find(leaf.name);
  if (!model || !model->leaf || model->leaf->table == LeafModel::Table::none)
    fail({}, "\"{}\" is neither a material that looks up a table, as {} or {}, nor name=value of a leaf", leaf.name,
         with_shares.name, with_modes.name);
  if (is_leaf_file && model->leaf->table == LeafModel::Table::shares)
    fail({}, "{}: a .leaf file is of {}, a table of {} is a .csv file", run.args.text("output"), with_modes.name,
         model->name);
  if (run.args.given("specimen")) leaf.params.emplace_back("specimen", run.args.text("specimen"));
  std::map<std::string, std::string> given;
  for (const auto& [name, value] : leaf.params) {
    check_is_of_leaf(name, run.args);
    // Its own R and T differ from those of the walk that this job would solve.
    if (model->leaf->table == LeafModel::Table::shares && leaf::find_plate_number(name))
      fail({}, "\"{}\" needs no table: {} computes the reflectance and transmittance of PROSPECT itself", name,
           model->name);
    if ((name == "fluorescence" || name == "fluorescencematrices") && value != "0")
      run.log().warn({}, fmt::format("\"{}\" is left out: a table holds no fluorescence; frond spectrophotometer "
                                     "--fluorescence writes matrices, which every leaf takes by fluorescencematrices",
                                     name));
    if (const auto [first, is_new] = given.emplace(name, value); !is_new)
      fail({}, "\"{}\" is given twice, as {} and as {}", name, first->second, value);
  }
  return {*model, std::move(leaf)};
}

/// Returns --wavelengths in the given order. Throws InputError for duplicates.
std::vector<double> wavelengths_in_order(const Arguments& args) {
  const auto nm = args.numbers("wavelengths");
  auto sorted = nm;
  std::ranges::sort(sorted);
  if (const auto twice = std::ranges::adjacent_find(sorted); twice != sorted.end())
    fail({}, "{} has {} twice", args.spelled("wavelengths"), *twice);
  return nm;
}

/// Returns --angles, which must ascend. With --equalsides: angles up to 90 and their counterparts on the other side.
std::vector<double> table_angles(const Arguments& args) {
  auto theta_deg = args.numbers("angles");
  const auto wrong = std::ranges::adjacent_find(theta_deg, std::greater_equal());
  if (wrong != theta_deg.end())
    fail({}, "{} must ascend: {} follows {}", args.spelled("angles"), *std::next(wrong), *wrong);
  if (!args.flag("equalsides")) return theta_deg;
  std::erase_if(theta_deg, [](double theta) { return theta > 90; });
  if (theta_deg.empty()) fail({}, "{} needs angles up to 90", args.spelled("equalsides"));
  for (size_t i = theta_deg.size(); i-- > 0;)
    if (theta_deg[i] < 90) theta_deg.push_back(180 - theta_deg[i]);
  return theta_deg;
}

/// Writes the file and logs its summary.
Result write_table(const JobRun& run, const std::string& content, const std::string& summary) {
  write_text(run.args.text("output"), content);
  run.log().info(summary);
  return {};
}

/// Returns a size rounded to kB of 1024 bytes.
std::string kilobytes(size_t bytes) { return fmt::format("{} kB", (bytes + 512) / 1024); }

/// Writes the table of shares as CSV.
Result make_shares_file(const JobRun& run, const TableLeaf& leaf) {
  const PluginInfo only_tissue{"the table of", leaf.model.name, "", "", leaf_params()};
  const Arguments& args = run.args;
  leaf::TableRequest request{.params = LeafParams(constant_params(only_tissue, leaf.text)).tissue(),
                             .wavelengths_nm = wavelengths_in_order(args),
                             .theta_deg = table_angles(args),
                             .rays = int(args.count("rays")),
                             .nodes = int(args.count("nodes")),
                             .seed = args.seed("seed")};
  if (args.text("method") == "montecarlo") request.method = leaf::TableMethod::monte_carlo;
  const double start = cpu_seconds();
  leaf::Table table = leaf::make_table(request, run.session().pool());
  const double seconds = cpu_seconds() - start;
  std::string header = leaf::describe(request);
  if (args.flag("equalsides")) {
    table = leaf::mean_of_sides(table);
    header += "# mean of both sides\n";
  }
  return write_table(run, leaf::to_csv(table, header),
                     leaf::summary(request, args.text("output"), table) + fmt::format(", {:.2g} s of CPU", seconds));
}

/// Writes the mode table.
Result make_modes_file(const JobRun& run, const Params& params) {
  const leaf::ModeTableRequest request{.params = LeafParams(params).tissue(),
                                       .wavelengths_nm = wavelengths_in_order(run.args),
                                       .tolerance = params.real("tolerance"),
                                       .nodes = int(run.args.count("nodes"))};
  const double start = cpu_seconds();
  const leaf::ModeTable spectrum = leaf::make_mode_table(request, run.session().pool());
  const double seconds = cpu_seconds() - start;
  return write_table(run, leaf::to_text(request, spectrum, leaf::describe(request)),
                     leaf::summary(request, run.args.text("output"), spectrum) +
                         fmt::format(", {} in a render, {:.2g} s of CPU",
                                     kilobytes(leaf::ModeLookup(request, spectrum, false).bytes()), seconds));
}

/// Writes a .leaf file for other programs (docs/file_formats.md).
Result make_leaf_file(const JobRun& run, const Params& params) {
  LeafFileRequest request{.wavelengths_nm = wavelengths_in_order(run.args),
                          .tolerance = params.real("tolerance"),
                          .nodes = int(run.args.count("nodes"))};
  if (const auto depths = run.args.numbers("depths"); !depths.empty()) request.depths = {depths[0], depths[1]};
  const leaf::LeafFile table =
      make_leaf_file(LeafParams(params), std::move(request), run.session().pool(), run.log(), {});
  const std::string bytes = leaf::leaf_file_bytes(table);
  return write_table(run, bytes,
                     fmt::format("{}: {}{}, {}", run.args.text("output"), table.is_reciprocal ? "reciprocal, " : "",
                                 counted(table.wavelengths_nm.size(), "wavelength"), kilobytes(bytes.size())));
}

/// Throws InputError for a given parameter that has no effect on this type of table. `use` names the type that it
/// applies to.
void reject(const Arguments& args, std::initializer_list<std::string_view> names, const std::string& use) {
  for (const std::string_view name : names)
    if (args.given(name)) fail({}, "{} is for {}", args.spelled(name), use);
}

/// The job: selects the file format by material and extension.
Result table(const JobRun& run) {
  const TableLeaf leaf = leaf_of(run);
  const bool is_leaf_file = run.args.text("output").ends_with(".leaf");
  if (!leaf.has_modes() || !is_leaf_file) reject(run.args, {"depths"}, "a .leaf file");
  if (leaf.has_modes()) {
    reject(run.args, {"method", "angles", "rays", "seed", "equalsides"},
           fmt::format("tables of {}; those of {} follow from its \"tolerance\"",
                       model_with(LeafModel::Table::shares, run.session().registry()).name, leaf.model.name));
    const Params params = constant_params(leaf.model, leaf.text);
    return is_leaf_file ? make_leaf_file(run, params) : make_modes_file(run, params);
  }
  const std::string method = run.args.spelled("method");
  if (run.args.text("method") == "montecarlo")
    reject(run.args, {"nodes"}, method + " solve");
  else
    reject(run.args, {"rays", "seed"}, method + " montecarlo");
  return make_shares_file(run, leaf);
}

}  // namespace

extern const JobInfo kTableJob(
    "table", "Leaf models", "Compute the table of a leaf material and write it to a file for its \"tablefile\".",
    "R and T by angle and wavelength, as CSV; or the mode table of a BSDF, and as FILE.leaf the complete material for "
    "other programs.",
    kTableParams, SessionUse::threads, table);

}  // namespace frond

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "report/fit_report.h"

// Reports of fits of many leaves.

namespace frond {
namespace {

using leaf::LeafNumber;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Whether leaves with these absorption tables have the number.
bool is_stated(const LeafNumber& n, leaf::AbsorptionTables tables) { return !n.only_with || *n.only_with == tables; }

/// Adds the columns that say which leaf the numbers describe.
void add_kind(const LeafFitReport& leaf, leaf::AbsorptionTables tables, Table& table) {
  const bool is_fitted = leaf.error.empty(), is_bifacial = leaf.result.params.structure == leaf::Structure::bifacial;
  table.add("specimen", is_fitted ? std::string(leaf.result.specimen->name) : "");
  table.add("structure", !is_fitted ? "" : is_bifacial ? "bifacial" : "unifacial");
  table.add("sieve", !is_fitted ? "" : leaf.result.params.sieve_and_detour ? "true" : "false");
  table.add("absorption", tables == leaf::AbsorptionTables::prospect ? "prospect" : "baranoski");
}

/// Names of the leaves in scenes and specimen files; a name that several files have is preceded by the file's.
std::vector<std::string> names_of(const std::vector<LeafFitReport>& leaves) {
  std::map<std::string, size_t> uses;
  for (const LeafFitReport& leaf : leaves) ++uses[leaf.leaf];
  std::vector<std::string> names;
  for (const LeafFitReport& leaf : leaves) {
    std::string& name = names.emplace_back(uses[leaf.leaf] > 1 ? leaf.file + "/" + leaf.leaf : leaf.leaf);
    std::erase_if(name, [](char c) { return c == '"' || c == '\\'; });  // which end or escape a string of a scene
  }
  return names;
}

void add_parameters(const LeafFitReport& leaf, leaf::AbsorptionTables tables, Table& table) {
  std::vector<std::string_view> undetermined;
  for (const LeafNumber& v : leaf::fit_variables()) {
    if (!is_stated(v, tables)) continue;
    const auto& numbers = leaf.result.numbers;
    const auto n = std::ranges::find(numbers, &v, &leaf::FittedNumber::variable);
    const bool has = leaf.error.empty() && n != numbers.end();
    // The error refers to the logarithm; a given number has none.
    table.add(std::string(v.name), has ? n->value : kNone, has && !n->is_fixed ? n->value * n->relative_error : kNone);
    if (has && !n->is_fixed && !n->is_identified()) undetermined.push_back(v.name);
  }
  // Parameters that follow others, then parameters of the specimen.
  for (const bool follows : {true, false})
    for (const LeafNumber& n : leaf::leaf_parameters())
      if (!n.is_fitted() && n.changes_shares() && n.follows.empty() != follows && is_stated(n, tables))
        table.add(std::string(n.name), leaf.error.empty() ? n.value(leaf.result.params) : kNone);
  table.add("undetermined", fmt::format("{}", fmt::join(undetermined, " ")));
}

void add_contents(const LeafFitReport& leaf, Table& table) {
  for (const leaf::AreaContent& c : leaf::area_contents()) {
    const auto& contents = leaf.result.contents;
    const auto found = std::ranges::find(contents, c.name, &leaf::FittedContent::name);
    const bool has = leaf.error.empty() && found != contents.end();
    const double value = has ? found->kg_per_m2 * c.unit.per_kg_per_m2 : kNone;
    table.add(fmt::format("{}{}", c.name, c.unit.column), value, has ? value * found->relative_error : kNone);
  }
}

void document(Table& table) {
  table.document("status", "fitted, or why the leaf was not fitted");
  table.document(
      "rmse",
      "root mean square error of R and T together; rmse_R, rmse_T: of one of them, blank if it was not measured");
  table.document("rmse_prospect", "of PROSPECT-D fitted to the same measurements: the columns N to this one's left");
  table.document("prior", "leaves of the prior over the structure, where only R or only T was measured");
  table.document("misfits", "number of bands in which R or T is off by more than 0.01");
  std::vector<std::string_view> coefficients;
  for (const LeafNumber& n : leaf::leaf_parameters())
    if (n.absorbs() && n.unit != leaf::kMassPerVolume) coefficients.insert(coefficients.begin(), n.name);
  table.document("thickness",
                 fmt::format("m; concentrations in kg/m^3, {} in 1/m; columns ending in _se: standard errors, those of "
                             "the logarithms times the value, blank for a given value",
                             fmt::join(coefficients, " and ")));
  table.document("undetermined", "parameters that the data do not determine: no measurements, they complete the leaf");
}

std::vector<double> errors_of(const std::vector<LeafFitReport>& leaves) {
  std::vector<double> errors;
  for (const LeafFitReport& leaf : leaves)
    if (leaf.error.empty()) errors.push_back(leaf.result.rmse);
  std::ranges::sort(errors);
  return errors;
}

/// Mean of the two middle values, if their number is even.
double median(const std::vector<double>& sorted) {
  return sorted.empty() ? kNone : (sorted[(sorted.size() - 1) / 2] + sorted[sorted.size() / 2]) / 2;
}

}  // namespace

Table leaves_table(const std::vector<LeafFitReport>& leaves, leaf::AbsorptionTables tables) {
  Table table{"leaves"};
  for (const LeafFitReport& leaf : leaves) {
    const leaf::FitResult& r = leaf.result;
    const bool is_fitted = leaf.error.empty();
    table.add("file", leaf.file);
    table.add("leaf", leaf.leaf);
    table.add("status", is_fitted ? "fitted" : leaf.error);
    table.add("measurements", double(leaf.measurements));
    table.add("rmse", is_fitted ? r.rmse : kNone);
    table.add("rmse_R", is_fitted ? r.rmse_r.value_or(kNone) : kNone);
    table.add("rmse_T", is_fitted ? r.rmse_t.value_or(kNone) : kNone);
    table.add("misfits", is_fitted ? double(r.misfits.size()) : kNone);
    add_kind(leaf, tables, table);
    table.add("prior", is_fitted && r.prior ? r.prior->source : "");
    add_parameters(leaf, tables, table);
    add_contents(leaf, table);
    // PROSPECT's names and units, beside frond's contents.
    for (size_t i = 0; i < leaf::plate_numbers().size(); ++i)
      table.add(std::string(leaf::plate_numbers()[i].name), leaf.plates ? leaf.plates->leaf.values[i] : kNone);
    table.add("rmse_prospect", leaf.plates ? leaf.plates->rmse : kNone);
  }
  if (!leaves.empty()) document(table);
  return table;
}

std::vector<Fact> leaves_facts(const std::vector<LeafFitReport>& leaves) {
  const std::vector<double> errors = errors_of(leaves);
  return {{"leaves", double(leaves.size())},
          {"fitted", double(errors.size())},
          {"failed", double(leaves.size() - errors.size())},
          {"median_rmse", median(errors)},
          {"largest_rmse", errors.empty() ? kNone : errors.back()}};
}

std::string leaves_text(const std::vector<LeafFitReport>& leaves) {
  constexpr size_t kNamed = 10;
  const std::vector<double> errors = errors_of(leaves);
  const size_t failed = leaves.size() - errors.size();
  std::string text = fmt::format("{} leaves: {} fitted, {} failed", leaves.size(), errors.size(), failed);
  if (!errors.empty()) text += fmt::format("; RMSE: median {:.4f}, largest {:.4f}", median(errors), errors.back());
  text += '\n';
  const auto by_prior = std::ranges::count_if(leaves, [](const auto& leaf) { return leaf.result.prior != nullptr; });
  if (by_prior > 0)
    text += fmt::format("  {} with R alone or T alone: the structure follows a prior (docs/fit.md)\n", by_prior);
  size_t named = 0;
  for (const LeafFitReport& leaf : leaves)
    if (!leaf.error.empty() && named++ < kNamed) text += fmt::format("  {}: {}\n", leaf.leaf, leaf.error);
  if (failed > kNamed) text += fmt::format("  and {} more: column \"status\" of the table\n", failed - kNamed);
  return text;
}

std::string leaves_scene(const std::vector<LeafFitReport>& leaves, const std::string& material) {
  const std::vector<std::string> names = names_of(leaves);
  std::string text, all;
  for (size_t i = 0; i < leaves.size(); ++i) {
    const LeafFitReport& leaf = leaves[i];
    if (!leaf.error.empty()) continue;
    const std::string source = leaf.file.empty() ? leaf.leaf : leaf.file + ", " + leaf.leaf;
    text += fit_scene({leaf.request, leaf.result, source, material}, names[i]);
    all += fmt::format(" \"{}\"", names[i]);
  }
  return text + fmt::format(
                    "\n# One of these leaves for each instance: frond canopy --column leaf=0:1\n"
                    "Texture \"leaf\" \"float\" \"instance\" \"string column\" \"leaf\" \"float range\" [ 0 1 ]\n"
                    "MakeNamedMaterial \"all leaves\" \"string type\" \"mix\" \"texture select\" \"leaf\"\n"
                    "    \"string materials\" [{} ]\n",
                    all);
}

std::string specimens_csv(const std::vector<LeafFitReport>& leaves, const LeafFitReport& mean,
                          leaf::AbsorptionTables tables) {
  std::vector<std::string> names = names_of(leaves);
  Table table{"specimens"};
  std::map<std::string_view, std::vector<double>> logarithms;
  const auto add = [&](const LeafFitReport& leaf, const std::string& name) {
    if (!leaf.error.empty()) return;
    table.add("leaf", name);
    add_kind(leaf, tables, table);
    for (const LeafNumber& n : leaf::leaf_parameters())
      if (n.changes_shares() && is_stated(n, tables)) table.add(std::string(n.name), n.value(leaf.result.params));
    if (&leaf != &mean)
      for (const leaf::FittedNumber& n : leaf.result.numbers)
        if (!n.is_fixed) logarithms[n.variable->name].push_back(std::log(n.value));
  };
  for (size_t i = 0; i < leaves.size(); ++i) add(leaves[i], names[i]);
  add(mean, "mean");
  std::string spread = "standard deviations of the logarithms over the leaves:";
  for (const LeafNumber& n : leaf::fit_variables())
    if (const auto& logs = logarithms[n.name]; logs.size() > 1) {
      double sum = 0, squares = 0;
      for (const double v : logs) sum += v;
      for (const double v : logs) squares += std::pow(v - sum / double(logs.size()), 2);
      spread += fmt::format(" {} {:.3g}", n.name, std::sqrt(squares / double(logs.size() - 1)));
    }
  return to_csv(table, {"leaves fitted by frond fit, for \"string specimenfile\" \"FILE:LEAF\"", spread});
}

}  // namespace frond

#include "leaf/tissue/specimen_file.h"

#include <algorithm>

#include "leaf/tissue/specimens.h"
#include "system/file_bytes.h"
#include "system/text_table.h"

namespace frond::leaf {
namespace {

/// Throws InputError for a column that is no parameter: it is probably misspelt. Tables of fits, which have a status,
/// have columns for other purposes too.
void check_columns(const TextTable& table) {
  const auto& names = table.names();
  if (std::ranges::find(names, "status", &TableField::text) != names.end()) return;
  std::vector<std::string_view> known{"leaf", "specimen", "structure", "sieve", "absorption"};
  for (const LeafNumber& n : leaf_parameters()) known.push_back(n.name);
  for (size_t i = 0; i < names.size(); ++i)
    if (!names[i].text.empty() && std::ranges::find(known, names[i].text) == known.end())
      fail(table.names_where(i), "there is no parameter \"{}\"{}", names[i].text, suggestion(names[i].text, known));
}

/// The leaf of the table's current row.
TissueParams leaf_of_row(const TextTable& table) {
  const auto field = [&table](std::string_view column) {
    const auto found = std::ranges::find(table.names(), column, &TableField::text);
    return found == table.names().end() ? table.fields().size() : size_t(found - table.names().begin());
  };
  // Tables of fits have rows without numbers.
  if (const size_t i = field("status"); i < table.fields().size() && table.fields()[i].text != "fitted")
    fail(table.where(i), "this leaf was not fitted");
  /// Returns whether the column has the first of two words; `otherwise` without the column or a word.
  const auto is_first = [&](std::string_view column, std::string_view first, std::string_view second, bool otherwise) {
    const size_t i = field(column);
    const std::string_view word = i < table.fields().size() ? table.fields()[i].text : std::string_view();
    if (!word.empty() && word != first && word != second)
      fail(table.where(i), "{} is {} or {}, not \"{}\"", column, first, second, word);
    return word.empty() ? otherwise : word == first;
  };
  const bool is_bifacial = is_first("structure", "bifacial", "unifacial", true);
  const Specimen* specimen = &specimen_of(is_bifacial ? Structure::bifacial : Structure::unifacial);
  if (const size_t i = field("specimen"); i < table.fields().size() && !table.fields()[i].text.empty()) {
    specimen = find_specimen(table.fields()[i].text);
    if (!specimen)
      fail(table.where(i), "there is no specimen \"{}\"{}", table.fields()[i].text,
           suggestion(table.fields()[i].text, {std::begin(kSpecimenNames), std::end(kSpecimenNames)}));
  }
  TissueParams leaf = specimen->params;
  if (field("structure") < table.fields().size())
    leaf.structure = is_bifacial ? Structure::bifacial : Structure::unifacial;
  leaf.sieve_and_detour = is_first("sieve", "true", "false", leaf.sieve_and_detour);
  leaf.absorption_tables =
      is_first("absorption", "prospect", "baranoski", leaf.absorption_tables == AbsorptionTables::prospect)
          ? AbsorptionTables::prospect
          : AbsorptionTables::baranoski;
  // A leaf of other tables than its specimen has none of the constituents that only the specimen's tables have.
  if (leaf.absorption_tables != specimen->params.absorption_tables)
    for (const LeafNumber& n : leaf_parameters())
      if (n.only_with == specimen->params.absorption_tables) n.value(leaf) = 0;
  for (size_t i = 0; i < table.fields().size(); ++i) {
    const LeafNumber* number = find_leaf_number(table.names()[i].text);
    if (!number || !number->is_parameter() || table.fields()[i].text.empty()) continue;
    const auto value = table.number(table.fields()[i].text);
    if (!value || !number->range.contains(*value))
      fail(table.where(i), "{} is a number from {:g} to {:g}{}{}", number->name, number->range.min, number->range.max,
           number->unit.empty() ? "" : " ", number->unit);
    number->value(leaf) = *value;
  }
  return leaf;
}

}  // namespace

TissueParams parse_specimen(std::string_view text, const std::string& file, std::string_view name) {
  TextTable table(text, file);
  const auto found = std::ranges::find(table.names(), "leaf", &TableField::text);
  if (found == table.names().end())
    fail(table.names_where(), "a specimen file has a column \"leaf\" and one for each parameter, by their names");
  check_columns(table);
  const auto label = size_t(found - table.names().begin());
  std::optional<TissueParams> leaf;
  std::vector<std::string> names;
  while (table.next()) {
    table.check_fields();
    names.emplace_back(table.fields()[label].text);
    if (!name.empty() && names.back() != name) continue;
    if (leaf && !name.empty()) fail(table.where(label), "the leaf \"{}\" occurs twice", name);
    if (!leaf) leaf = leaf_of_row(table);
  }
  if (!leaf && !name.empty())
    fail(table.names_where(), "there is no leaf \"{}\"{}", name, suggestion(name, {names.begin(), names.end()}));
  if (!leaf || (name.empty() && names.size() > 1))
    fail(table.names_where(), "the file has {} leaves: FILE:LEAF selects one{}", names.size(),
         names.empty() ? "" : fmt::format(", as in {}:{}", std::filesystem::path(file).filename().string(), names[0]));
  return *leaf;
}

TissueParams read_specimen(const std::filesystem::path& path, std::string_view name, const Location& where) {
  return parse_specimen(read_file_bytes(path, where, "specimen file"), path.string(), name);
}

}  // namespace frond::leaf

#include "materials/table_file_param.h"

#include <fmt/ranges.h>

#include <utility>

#include "core/log.h"
#include "leaf/fit/measured_table.h"
#include "materials/leaf_params.h"

namespace frond {
TableFileParam::TableFileParam(const Params& p, std::span<const std::string_view> also) : also_(also) {
  if (!p.given("tablefile")) return;
  path_ = p.file("tablefile");
  where_ = p.where("tablefile");
  for (const Param& of_leaf : leaf_params())
    if (is_of_tissue(of_leaf)) note_unused(p, of_leaf.name);
  for (const std::string_view name : also) note_unused(p, name);
}

std::shared_ptr<const leaf::Table> TableFileParam::read(const Params& p, double surface) {
  const std::string leaf = p.given("tableleaf") ? p.string("tableleaf") : "";
  if (path_.empty() && p.given("tableleaf"))
    fail(p.where("tableleaf"), "\"tableleaf\" has no effect without \"tablefile\"");
  if (path_.empty()) plates_ = plate_leaf(p);
  if (!is_given()) return nullptr;
  if (plates_) {
    where_ = p.where("N");
    for (const std::string_view name : also_) note_unused(p, name);
    key_ = fmt::format("leaf of plates {}, surface {}", fmt::join(plates_->values, " "), surface);
    leaf::MeasuredTable made = leaf::measured_table({.measurements = leaf::plate_spectra(*plates_)}, surface, name());
    return std::make_shared<const leaf::Table>(std::move(made.table));
  }
  leaf::MeasuredTable read =
      leaf::read_table_or_spectra(path_, where_, {.leaf = leaf, .leaf_option = "\"string tableleaf\""}, surface);
  changes_ = std::move(read.warning);
  key_ = fmt::format("leaf table file {} {} {}", path_.string(), surface, leaf);
  return std::make_shared<const leaf::Table>(std::move(read.table));
}

void TableFileParam::note_unused(const Params& p, std::string_view name) {
  if (p.given(name)) unused_.push_back({name, p.where(name)});
}

void TableFileParam::warn(const Log& log) {
  for (const auto& [name, where] : std::exchange(unused_, {}))
    log.warn(where,
             fmt::format("\"{}\" has no effect with {}", name, plates_ ? "PROSPECT's parameters" : "\"tablefile\""));
  if (!changes_.empty()) log.warn(where_, std::exchange(changes_, {}));
}

}  // namespace frond

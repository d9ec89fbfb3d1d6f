#include "materials/table_file_param.h"

#include <utility>

#include "core/log.h"
#include "leaf/fit/measured_table.h"

namespace frond {
namespace {

// Parameters that a table file replaces.
constexpr std::string_view kOfTissue[] = {"thickness",
                                          "mesophyllfraction",
                                          "chlorophylla",
                                          "chlorophyllb",
                                          "carotenoids",
                                          "protein",
                                          "cellulose",
                                          "lignin",
                                          "otherabsorption",
                                          "pigments",
                                          "pigmentconcentrations",
                                          "epidermisaspect",
                                          "palisadeaspect",
                                          "spongyaspect",
                                          "sieve"};

}  // namespace

TableFileParam::TableFileParam(const Params& p, std::span<const std::string_view> also) {
  if (!p.given("tablefile")) return;
  path_ = p.file("tablefile");
  where_ = p.where("tablefile");
  look_for(p, kOfTissue);
  look_for(p, also);
}

std::shared_ptr<const leaf::Table> TableFileParam::read(const Params& p, double surface) {
  const std::string leaf = p.given("tableleaf") ? p.string("tableleaf") : "";
  if (!is_given()) {
    if (p.given("tableleaf")) fail(p.where("tableleaf"), "\"tableleaf\" has no effect without \"tablefile\"");
    return nullptr;
  }
  leaf::MeasuredTable read =
      leaf::read_table_or_spectra(path_, where_, {.leaf = leaf, .leaf_option = "\"string tableleaf\""}, surface);
  changes_ = std::move(read.warning);
  key_ = fmt::format("leaf table file {} {} {}", path_.string(), surface, leaf);
  return std::make_shared<const leaf::Table>(std::move(read.table));
}

void TableFileParam::look_for(const Params& p, std::span<const std::string_view> names) {
  for (const std::string_view name : names)
    if (p.given(name)) unused_.push_back({name, p.where(name)});
}

void TableFileParam::warn(const Log& log) {
  for (const auto& [name, where] : std::exchange(unused_, {}))
    log.warn(where, fmt::format("\"{}\" has no effect with \"tablefile\"", name));
  if (!changes_.empty()) log.warn(where_, std::exchange(changes_, {}));
}

}  // namespace frond

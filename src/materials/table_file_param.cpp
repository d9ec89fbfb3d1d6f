#include "materials/table_file_param.h"

#include <utility>

#include "core/log.h"

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

void TableFileParam::look_for(const Params& p, std::span<const std::string_view> names) {
  for (const std::string_view name : names)
    if (p.given(name)) unused_.push_back({name, p.where(name)});
}

void TableFileParam::warn(const Log& log) {
  for (const auto& [name, where] : std::exchange(unused_, {}))
    log.warn(where, fmt::format("\"{}\" has no effect with \"tablefile\"", name));
}

}  // namespace frond

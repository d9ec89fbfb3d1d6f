#include "study/choose/ladder.h"

#include <algorithm>
#include <array>
#include <stdexcept>

namespace frond::choose {
namespace {

struct Price {
  std::string_view model;
  double price;
};
constexpr std::array kPrices{Price{"leaf_lambert", 1}, Price{"leaf_simplified", 1.07}, Price{"leaf_solved", 1.15},
                             Price{"abm", 1.77}};

double price_of(std::string_view model) {
  const auto found = std::ranges::find(kPrices, model, &Price::model);
  if (found == kPrices.end()) throw std::logic_error(fmt::format("the ladder has no price for {}", model));
  return found->price;
}

/// Returns the models of `leaf` after "auto".
std::span<const std::string_view> models_of(const MaterialInfo& leaf) {
  return find_param(leaf, "model")->choices.subspan(1);
}

}  // namespace

Ladder standard_ladder(const Registry& registry) {
  Ladder ladder;
  for (const std::string_view model : models_of(registry.materials.get("leaf", {}))) {
    const std::string name(model);
    const bool is_exact = name == "leaf_solved" || name == "abm";
    ladder.models.push_back({name, {"leaf", {{"model", name}}}, price_of(model), is_exact});
  }
  for (const auto& [text, price] : {std::pair{"smpte", 0.88}, {"meyer,white=D65", 0.92}, {"hero", 1.0}})
    ladder.wavelengths.push_back({text, parse_plugin_text(text, {}), price});
  return ladder;
}

}  // namespace frond::choose

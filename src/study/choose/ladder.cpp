#include "study/choose/ladder.h"

#include "scene/leaf_models.h"

namespace frond::choose {
Ladder standard_ladder(const Registry& registry) {
  Ladder ladder;
  const std::string open(open_leaf(registry).name);
  const std::string_view reference = reference_model(registry).name;
  for (const MaterialInfo* model : leaf_models(registry)) {
    // A model of another reference cannot be judged by this one.
    if (model->leaf->reference != reference) continue;
    const std::string name(model->name);
    ladder.models.push_back({name, {open, {{"model", name}}}, model->leaf->cost, model->leaf->is_exact});
  }
  for (const auto& [text, price] : {std::pair{"smpte", 0.88}, {"meyer,white=D65", 0.92}, {"hero", 1.0}})
    ladder.wavelengths.push_back({text, parse_plugin_text(text, {}), price});
  return ladder;
}

}  // namespace frond::choose

#include "imports/imported_loss.h"

#include <algorithm>

namespace frond {
namespace {

/// A hostile file may have any number of unknown properties.
constexpr size_t kMostKinds = 200;

}  // namespace

ImportedLoss* LossList::find(const std::string& what, bool is_of_material) {
  const auto found = std::ranges::find_if(
      all_, [&](const ImportedLoss& loss) { return loss.what == what && !loss.materials.empty() == is_of_material; });
  return found == all_.end() ? nullptr : &*found;
}

void LossList::add(const std::string& what, uint64_t count) {
  if (ImportedLoss* known = find(what, false))
    known->count += count;
  else if (all_.size() < kMostKinds)
    all_.push_back({what, count});
  else
    add("further properties");
}

void LossList::add_for_material(const std::string& material, const std::string& what, bool is_shape) {
  ImportedLoss* known = find(what, true);
  if (!known && all_.size() >= kMostKinds) return add("further properties");
  if (!known) known = &all_.emplace_back(ImportedLoss{what, 0, {}, !is_shape});
  ++known->count;
  if (known->materials.empty() || known->materials.back() != material) known->materials.push_back(material);
}

std::string text_of(const ImportedLoss& loss) {
  constexpr size_t kMostNames = 5;
  std::string text = loss.what;
  for (size_t i = 0; i < loss.materials.size() && i < kMostNames; ++i)
    text += (i == 0 ? " of \"" : ", \"") + loss.materials[i] + "\"";
  if (loss.materials.size() > kMostNames)
    text += " and " + std::to_string(loss.materials.size() - kMostNames) + " more";
  else if (loss.materials.empty() && loss.count > 1)
    text += " (" + std::to_string(loss.count) + " times)";
  return text;
}

}  // namespace frond

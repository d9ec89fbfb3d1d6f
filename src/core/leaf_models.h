#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "core/material.h"

namespace frond {

/// Returns the leaf models among these materials from the cheapest to the most expensive; models of equal cost keep the
/// given order. Open leaf materials are not among them.
inline std::vector<const MaterialInfo*> leaf_models(std::span<const MaterialInfo* const> materials) {
  std::vector<const MaterialInfo*> models;
  std::ranges::copy_if(materials, std::back_inserter(models),
                       [](const MaterialInfo* m) { return m->leaf && !m->leaf->is_open; });
  std::ranges::stable_sort(models, {}, [](const MaterialInfo* m) { return m->leaf->cost; });
  return models;
}

/// Returns the first of these materials that is a leaf model and its own reference; nullptr if there is none.
inline const MaterialInfo* reference_model(std::span<const MaterialInfo* const> materials) {
  const auto found = std::ranges::find_if(
      materials, [](const MaterialInfo* m) { return m->leaf && !m->leaf->is_open && m->leaf->reference == m->name; });
  return found == materials.end() ? nullptr : *found;
}

}  // namespace frond

#pragma once

#include <string>
#include <vector>

#include "scene/format/description.h"
#include "scene/registry.h"

namespace frond {

// Queries of the records of a registry's leaf materials (MaterialInfo::leaf), including plug-ins of shared objects.

/// Returns the leaf models from the cheapest to the most expensive (core/leaf_models.h).
std::vector<const MaterialInfo*> leaf_models(const Registry& registry);
/// Returns the open material, for which the renderer selects a model.
const MaterialInfo& open_leaf(const Registry& registry);
/// Returns the first model in the registry that is its own reference.
const MaterialInfo& reference_model(const Registry& registry);
/// Whether the mean of the model's BSDF equals that of reference_model.
bool is_exact(const MaterialInfo& model, const Registry& registry);
/// Returns the cheapest exact model without noise.
const MaterialInfo& noiseless_model(const Registry& registry);
/// Returns the most expensive model that reads this kind of table, which makes most use of it.
const MaterialInfo& model_with(LeafModel::Table table, const Registry& registry);
/// Whether the material is a leaf that reads a table of a file.
bool reads_table(const ParsedPlugin& plugin, const Registry& registry);
/// Returns the model as text with its LeafModel::quiet: "NAME,parameter=value"; its name if it has none.
std::string quiet_text(const MaterialInfo& model);

/// Whether the material is a mixture: it has parameters that name materials.
bool is_mixture(const MaterialInfo& info);
/// Returns a flag by material index: whether it is a leaf, or a mixture with one.
std::vector<uint8_t> leaf_flags(const SceneSettings& description, const Registry& registry);
/// Returns the indices of the materials that are leaves. A mixture is not, but the materials that it mixes may be.
/// Throws InputError for an unknown material plug-in.
std::vector<size_t> leaf_materials(const SceneSettings& description, const Registry& registry);

}  // namespace frond

#include <algorithm>
#include <array>
#include <stdexcept>

#include "core/material.h"
#include "materials/leaf_params.h"

namespace frond {

extern const MaterialInfo abm_material;
extern const MaterialInfo leaf_lambert_material;
extern const MaterialInfo leaf_simplified_material;
extern const MaterialInfo leaf_solved_material;

namespace {

constexpr std::string_view kAuto = "auto";

/// A leaf model; kLadder orders them from the cheapest to the most accurate.
struct Model {
  std::string_view name;
  const MaterialInfo* info;
};
constexpr std::array kLadder{Model{"leaf_lambert", &leaf_lambert_material},
                             Model{"leaf_simplified", &leaf_simplified_material},
                             Model{"leaf_solved", &leaf_solved_material}, Model{"abm", &abm_material}};

constexpr auto kModels = [] {
  std::array<std::string_view, kLadder.size() + 1> names{kAuto};
  std::ranges::transform(kLadder, names.begin() + 1, &Model::name);
  return names;
}();
constexpr Param kOwn[] = {
    {.name = "model",
     .kind = ParamKind::string,
     .default_value = kAuto,
     .doc = "Leaf model. auto: frond render selects the cheapest that meets maxrms (docs/selection.md); other commands "
            "use "
            "abm with weighted walks, or leaf_solved if incident is reciprocal.",
     .choices = kModels},
    {.name = "maxrms",
     .kind = ParamKind::real,
     .default_value = 0.01,
     .range = {1e-6, 1},
     .doc = "Largest RMS error of the image that the model may cause, in linear SMPTE-C (white: 1)."},
};
constexpr auto kLeaf = with_leaf_params(kOwn);

/// The material of a model; for "auto", the exact model that the leaf's incident direction permits.
const MaterialInfo& material_of(std::string_view model, bool is_reciprocal) {
  if (model == kAuto) return is_reciprocal ? leaf_solved_material : abm_material;
  const auto found = std::ranges::find(kLadder, model, &Model::name);
  if (found == kLadder.end()) throw std::logic_error("no leaf model is called " + std::string(model));
  return *found->info;
}

ParsedParam weighted_walks() { return {"string", "mode", {}, {}, std::vector<std::string>{"weighted"}}; }

/// Does not select a model, since a material has no access to the image: the renderer (docs/selection.md) replaces
/// "auto" by a model's name before the material is made.
std::unique_ptr<Material> make_leaf(const Params& p) {
  // Read so that the parameter counts as used; the renderer reads the value.
  (void)p.real("maxrms");
  const MaterialInfo& info = material_of(p.string("model"), p.string("incident") == "reciprocal");
  const bool walks = &info == &abm_material;
  return info.make(p.forwarded(info, walks ? std::vector{weighted_walks()} : std::vector<ParsedParam>{}));
}

}  // namespace

extern const MaterialInfo leaf_material{
    {"material", "leaf", "Open leaf: replaced by the cheapest leaf model that meets a stated error of the image.",
     "docs/selection.md", kLeaf},
    make_leaf};

}  // namespace frond
